#include "app/display/vulkan_device.h"

#include <algorithm>
#include <optional>
#include <vector>

#include "app/display/no_display.h"
#include "tracer/ground/error.h"

namespace raywalk {
namespace {

constexpr const char* without_vulkan = "\n  Without Vulkan, `-render OUT` still makes a picture.";

int preference(vk::PhysicalDeviceType type) {
    switch (type) {
        case vk::PhysicalDeviceType::eDiscreteGpu:
            return 4;
        case vk::PhysicalDeviceType::eIntegratedGpu:
            return 3;
        case vk::PhysicalDeviceType::eVirtualGpu:
            return 2;
        case vk::PhysicalDeviceType::eCpu:
            return 1;
        default:
            return 0;
    }
}

bool has_extension(const vk::raii::PhysicalDevice& device, std::string_view wanted) {
    const auto extensions = device.enumerateDeviceExtensionProperties();
    return std::ranges::any_of(extensions, [&](const auto& e) { return wanted == e.extensionName.data(); });
}

// A queue family that draws and, where there is a surface, presents to it. (Of a display of 16 bits a pixel a driver
// may say that it presents to it, and offer no format.)
std::optional<std::uint32_t> suitable_family(const vk::raii::PhysicalDevice& device, vk::SurfaceKHR surface) {
    if (device.getProperties().apiVersion < VK_API_VERSION_1_3) return {};
    const auto features = device.getFeatures2<vk::PhysicalDeviceFeatures2, vk::PhysicalDeviceVulkan13Features>();
    const auto& v13 = features.get<vk::PhysicalDeviceVulkan13Features>();
    if (!v13.dynamicRendering || !v13.synchronization2) return {};
    if (surface && !has_extension(device, VK_KHR_SWAPCHAIN_EXTENSION_NAME)) return {};
    const auto families = device.getQueueFamilyProperties();
    for (std::uint32_t i = 0; i < families.size(); ++i)
        if ((families[i].queueFlags & vk::QueueFlagBits::eGraphics) &&
            (!surface || (device.getSurfaceSupportKHR(i, surface) && !device.getSurfaceFormatsKHR(surface).empty())))
            return i;
    return {};
}

std::uint32_t memory_type(const VulkanDevice& device, std::uint32_t allowed, vk::MemoryPropertyFlags required,
                          vk::MemoryPropertyFlags preferred) {
    const auto memory = device.physical.getMemoryProperties();
    for (const vk::MemoryPropertyFlags wanted : {required | preferred, required})
        for (std::uint32_t i = 0; i < memory.memoryTypeCount; ++i)
            if ((allowed >> i & 1) && (memory.memoryTypes[i].propertyFlags & wanted) == wanted) return i;
    throw WorkError("the Vulkan device " + device.name + " has no memory of the kind that frames need");
}

}  // namespace

VulkanInstance make_instance(std::span<const char* const> extensions) {
    std::optional<vk::raii::Context> context;
    try {
        context.emplace();
    } catch (const std::exception&) {
        throw NoDisplayError(std::string("no Vulkan: the loader library libvulkan.so.1 was not found"
                                         "\n  On Debian: apt install libvulkan1 mesa-vulkan-drivers") +
                             without_vulkan);
    }
    try {
        const vk::ApplicationInfo application{
            .pApplicationName = "raywalk", .applicationVersion = 1, .apiVersion = VK_API_VERSION_1_3};
        vk::raii::Instance instance(
            *context, vk::InstanceCreateInfo{.pApplicationInfo = &application,
                                             .enabledExtensionCount = static_cast<std::uint32_t>(extensions.size()),
                                             .ppEnabledExtensionNames = extensions.data()});
        return {std::move(*context), std::move(instance)};
    } catch (const vk::SystemError& error) {
        throw NoDisplayError(std::string("no Vulkan: no driver could be opened (") + error.what() + ")" +
                             vulkan_driver_advice() + without_vulkan);
    }
}

VulkanDevice make_device(const VulkanInstance& instance, vk::SurfaceKHR surface) {
    std::vector<vk::raii::PhysicalDevice> devices;
    try {
        for (VkPhysicalDevice handle :
             (*instance.instance).enumeratePhysicalDevices(*instance.instance.getDispatcher()))
            devices.emplace_back(instance.instance, handle);
    } catch (const vk::SystemError&) {
        // No driver at all: told below.
    }
    const vk::raii::PhysicalDevice* best = nullptr;
    std::uint32_t best_family = 0;
    for (const auto& candidate : devices) {
        const auto family = suitable_family(candidate, surface);
        if (!family) continue;
        if (best && preference(candidate.getProperties().deviceType) <= preference(best->getProperties().deviceType))
            continue;
        best = &candidate;
        best_family = *family;
    }
    if (!best) {
        throw NoDisplayError((devices.empty() ? std::string("no Vulkan device was found")
                              : surface       ? std::string("no Vulkan 1.3 device can show pictures on this display")
                                              : std::string("no Vulkan 1.3 device was found")) +
                             vulkan_driver_advice() + without_vulkan);
    }

    const float priority = 1;
    const vk::DeviceQueueCreateInfo queue{
        .queueFamilyIndex = best_family, .queueCount = 1, .pQueuePriorities = &priority};
    const char* swapchain = VK_KHR_SWAPCHAIN_EXTENSION_NAME;
    const vk::PhysicalDeviceVulkan13Features features{.synchronization2 = true, .dynamicRendering = true};
    vk::raii::Device device(*best, vk::DeviceCreateInfo{.pNext = &features,
                                                        .queueCreateInfoCount = 1,
                                                        .pQueueCreateInfos = &queue,
                                                        .enabledExtensionCount = surface ? 1u : 0u,
                                                        .ppEnabledExtensionNames = &swapchain});
    vk::raii::Queue first_queue(device, best_family, 0);
    const auto properties = best->getProperties();
    return {.physical = *best,
            .queue_family = best_family,
            .device = std::move(device),
            .queue = std::move(first_queue),
            .type = properties.deviceType,
            .name = properties.deviceName.data()};
}

VulkanBuffer make_buffer(const VulkanDevice& device, vk::DeviceSize size, vk::BufferUsageFlags usage,
                         vk::MemoryPropertyFlags properties, vk::MemoryPropertyFlags preferred) {
    VulkanBuffer result;
    result.size = size;
    result.buffer = {device.device, vk::BufferCreateInfo{.size = size, .usage = usage}};
    const auto needs = result.buffer.getMemoryRequirements();
    result.memory = {device.device, vk::MemoryAllocateInfo{.allocationSize = needs.size,
                                                           .memoryTypeIndex = memory_type(device, needs.memoryTypeBits,
                                                                                          properties, preferred)}};
    result.buffer.bindMemory(*result.memory, 0);
    if (properties & vk::MemoryPropertyFlagBits::eHostVisible) result.data = result.memory.mapMemory(0, VK_WHOLE_SIZE);
    return result;
}

VulkanImage make_image(const VulkanDevice& device, vk::Extent2D extent, vk::Format format, vk::ImageUsageFlags usage) {
    VulkanImage result;
    result.extent = extent;
    result.image = {device.device, vk::ImageCreateInfo{.imageType = vk::ImageType::e2D,
                                                       .format = format,
                                                       .extent = {extent.width, extent.height, 1},
                                                       .mipLevels = 1,
                                                       .arrayLayers = 1,
                                                       .samples = vk::SampleCountFlagBits::e1,
                                                       .tiling = vk::ImageTiling::eOptimal,
                                                       .usage = usage}};
    const auto needs = result.image.getMemoryRequirements();
    result.memory = {device.device, vk::MemoryAllocateInfo{
                                        .allocationSize = needs.size,
                                        .memoryTypeIndex = memory_type(device, needs.memoryTypeBits,
                                                                       vk::MemoryPropertyFlagBits::eDeviceLocal, {})}};
    result.image.bindMemory(*result.memory, 0);
    result.view = make_view(device.device, *result.image, format);
    return result;
}

vk::raii::ImageView make_view(const vk::raii::Device& device, vk::Image image, vk::Format format) {
    return {device, vk::ImageViewCreateInfo{.image = image,
                                            .viewType = vk::ImageViewType::e2D,
                                            .format = format,
                                            .subresourceRange = {vk::ImageAspectFlagBits::eColor, 0, 1, 0, 1}}};
}

}  // namespace raywalk
