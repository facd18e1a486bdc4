// A Vulkan instance, the device that shows frames, and memory from it. Only the vulkan_* and presenter sources include
// this: the header below takes seconds to compile, and would take twice as long with all that is not needed of it.
#pragma once

#define VULKAN_HPP_NO_SETTERS
#define VULKAN_HPP_NO_SMART_HANDLE
#define VULKAN_HPP_NO_SPACESHIP_OPERATOR
#define VULKAN_HPP_NO_STRUCT_CONSTRUCTORS
#define VK_NO_PROTOTYPES
#include <span>
#include <string>
#include <vulkan/vulkan_raii.hpp>

namespace raywalk {

struct VulkanInstance {
    vk::raii::Context context;  // the loader, opened at run time
    vk::raii::Instance instance;
};

// Throws NoDisplayError when there is no loader or no driver.
VulkanInstance make_instance(std::span<const char* const> extensions);

struct VulkanDevice {
    vk::raii::PhysicalDevice physical;
    std::uint32_t queue_family;  // graphics, and able to present to the surface if there is one
    vk::raii::Device device;
    vk::raii::Queue queue;
    vk::PhysicalDeviceType type;
    std::string name;
};

// The best device: discrete, integrated, virtual, then processor. `surface` null: no window is asked of it.
// Throws NoDisplayError when none will do.
VulkanDevice make_device(const VulkanInstance& instance, vk::SurfaceKHR surface);

struct VulkanBuffer {
    vk::raii::DeviceMemory memory{nullptr};
    vk::raii::Buffer buffer{nullptr};
    void* data = nullptr;  // mapped where the memory is the host's
    vk::DeviceSize size = 0;
};
VulkanBuffer make_buffer(const VulkanDevice& device, vk::DeviceSize size, vk::BufferUsageFlags usage,
                         vk::MemoryPropertyFlags properties, vk::MemoryPropertyFlags preferred = {});

// A two-dimensional colour image with its view, in device memory.
struct VulkanImage {
    vk::raii::DeviceMemory memory{nullptr};
    vk::raii::Image image{nullptr};
    vk::raii::ImageView view{nullptr};
    vk::Extent2D extent;
};
VulkanImage make_image(const VulkanDevice& device, vk::Extent2D extent, vk::Format format, vk::ImageUsageFlags usage);
vk::raii::ImageView make_view(const vk::raii::Device& device, vk::Image image, vk::Format format);

}  // namespace raywalk
