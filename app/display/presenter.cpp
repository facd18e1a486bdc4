#include "app/display/presenter.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <optional>

#include "app/display/no_display.h"
#include "app/display/vulkan_device.h"
#include "app/display/vulkan_frame.h"
#include "tracer/ground/error.h"

#include <GLFW/glfw3.h>  // after the Vulkan headers, for its Vulkan functions

namespace raywalk {
namespace {

constexpr vk::Format offscreen_format = vk::Format::eB8G8R8A8Unorm;

vk::raii::CommandPool make_command_pool(const VulkanDevice& device) {
    return {device.device, vk::CommandPoolCreateInfo{.flags = vk::CommandPoolCreateFlagBits::eResetCommandBuffer,
                                                     .queueFamilyIndex = device.queue_family}};
}

vk::raii::CommandBuffer make_commands(const VulkanDevice& device, const vk::raii::CommandPool& pool) {
    return std::move(vk::raii::CommandBuffers(
                         device.device,
                         vk::CommandBufferAllocateInfo{
                             .commandPool = *pool, .level = vk::CommandBufferLevel::ePrimary, .commandBufferCount = 1})
                         .front());
}

// Runs Vulkan calls; a lost device or exhausted memory becomes the message that the user reads.
template <class Calls>
auto with_device_errors(const VulkanDevice& device, Calls&& calls) {
    try {
        return calls();
    } catch (const vk::DeviceLostError&) {
        throw WorkError(
            "the Vulkan device " + device.name +
            " was lost (its driver was reset or removed); start again, or use `-render OUT`, which needs none");
    } catch (const vk::SurfaceLostKHRError&) {
        throw NoDisplayError("the display was lost: its server ended, or the window did");
    } catch (const vk::SystemError& error) {
        throw WorkError("the Vulkan device " + device.name + " failed: " + error.what());
    }
}

void wait(const VulkanDevice& device, const vk::raii::Fence& fence) {
    static_cast<void>(device.device.waitForFences(*fence, true, std::numeric_limits<std::uint64_t>::max()));
}

// GLFW's list of what its surfaces need.
std::vector<const char*> window_extensions() {
    std::uint32_t count = 0;
    const char** names = glfwVulkanSupported() ? glfwGetRequiredInstanceExtensions(&count) : nullptr;
    if (!names) {
        make_instance({});  // says what is missing where Vulkan is not there at all
        throw NoDisplayError(
            "no Vulkan driver can show pictures on this display" + vulkan_driver_advice() +
            "\n  Without a display, `--capture OUT` shows what the window would; `-render OUT` needs no Vulkan.");
    }
    return {names, names + count};
}

vk::raii::SurfaceKHR make_surface(const vk::raii::Instance& instance, GLFWwindow* window) {
    VkSurfaceKHR surface = VK_NULL_HANDLE;
    if (glfwCreateWindowSurface(*instance, window, nullptr, &surface) != VK_SUCCESS)
        throw NoDisplayError("the window cannot be drawn to by Vulkan; `--capture OUT` needs no window");
    return {instance, surface};
}

}  // namespace

// ---- the window ----

struct Presenter::State {
    explicit State(GLFWwindow* w)
        : window(w),
          instance(make_instance(window_extensions())),
          surface(make_surface(instance.instance, w)),
          device(make_device(instance, *surface)),
          recorder(device),
          pool(make_command_pool(device)),
          commands(make_commands(device, pool)),
          acquired(device.device, vk::SemaphoreCreateInfo{}),
          done(device.device, vk::FenceCreateInfo{.flags = vk::FenceCreateFlagBits::eSignaled}) {}
    ~State() {
        try {
            device.device.waitIdle();
        } catch (const vk::SystemError&) {
            // A lost device has nothing left to wait for.
        }
    }

    Outcome present();
    bool rebuild();
    void choose_format();
    bool size_changed() const;
    FrameTarget target(std::uint32_t image) const;

    struct Image {
        vk::Image image;
        vk::raii::ImageView view;
        vk::raii::Semaphore rendered;  // its own, as the presentation engine may hold it until the image comes back
    };

    GLFWwindow* window;
    VulkanInstance instance;
    vk::raii::SurfaceKHR surface;
    VulkanDevice device;
    FrameRecorder recorder;
    vk::raii::CommandPool pool;
    vk::raii::CommandBuffer commands;
    vk::raii::Semaphore acquired;
    vk::raii::Fence done;  // signalled: the device has no work of ours

    vk::SurfaceFormatKHR format;
    vk::Extent2D extent;
    bool copies = false;  // swapchain images take copies
    vk::raii::SwapchainKHR swapchain{nullptr};
    std::vector<Image> images;
    bool stale = true;  // the swapchain is to be built anew
    FrameInfo shown;
};

// B8G8R8A8_UNORM is the frames' own format, and the first one offered is often an sRGB one, which would encode twice.
void Presenter::State::choose_format() {
    const auto formats = device.physical.getSurfaceFormatsKHR(*surface);
    format = formats.front();
    for (const vk::Format wanted :
         {vk::Format::eB8G8R8A8Unorm, vk::Format::eR8G8B8A8Unorm, vk::Format::eA8B8G8R8UnormPack32,
          vk::Format::eB8G8R8A8Srgb, vk::Format::eR8G8B8A8Srgb}) {
        const auto found = std::ranges::find_if(formats, [&](const vk::SurfaceFormatKHR& f) {
            return f.format == wanted && f.colorSpace == vk::ColorSpaceKHR::eSrgbNonlinear;
        });
        if (found != formats.end()) {
            format = *found;
            return;
        }
    }
}

// False when the window has no area.
bool Presenter::State::rebuild() {
    const auto surface_is = device.physical.getSurfaceCapabilitiesKHR(*surface);
    vk::Extent2D wanted = surface_is.currentExtent;
    if (wanted.width == std::numeric_limits<std::uint32_t>::max()) {  // the surface takes the swapchain's size
        int width = 0, height = 0;
        glfwGetFramebufferSize(window, &width, &height);
        if (width == 0 || height == 0) return false;
        wanted.width = std::clamp(static_cast<std::uint32_t>(width), surface_is.minImageExtent.width,
                                  surface_is.maxImageExtent.width);
        wanted.height = std::clamp(static_cast<std::uint32_t>(height), surface_is.minImageExtent.height,
                                   surface_is.maxImageExtent.height);
    }
    if (wanted.width == 0 || wanted.height == 0) return false;

    if (format.format == vk::Format::eUndefined) choose_format();
    copies = static_cast<bool>(surface_is.supportedUsageFlags & vk::ImageUsageFlagBits::eTransferDst);
    std::uint32_t count = surface_is.minImageCount + 1;
    if (surface_is.maxImageCount) count = std::min(count, surface_is.maxImageCount);
    vk::ImageUsageFlags usage = vk::ImageUsageFlagBits::eColorAttachment;
    if (copies) usage |= vk::ImageUsageFlagBits::eTransferDst;
    const auto opaque = surface_is.supportedCompositeAlpha & vk::CompositeAlphaFlagBitsKHR::eOpaque
                            ? vk::CompositeAlphaFlagBitsKHR::eOpaque
                            : vk::CompositeAlphaFlagBitsKHR::eInherit;

    device.device.waitIdle();  // images of the old swapchain may still be on their way to the screen
    images.clear();
    extent = wanted;
    const vk::raii::SwapchainKHR old = std::move(swapchain);
    swapchain = {device.device, vk::SwapchainCreateInfoKHR{.surface = *surface,
                                                           .minImageCount = count,
                                                           .imageFormat = format.format,
                                                           .imageColorSpace = format.colorSpace,
                                                           .imageExtent = extent,
                                                           .imageArrayLayers = 1,
                                                           .imageUsage = usage,
                                                           .preTransform = surface_is.currentTransform,
                                                           .compositeAlpha = opaque,
                                                           .presentMode = vk::PresentModeKHR::eFifo,
                                                           .clipped = true,
                                                           .oldSwapchain = *old}};
    for (VkImage image : swapchain.getImages())
        images.push_back({image, make_view(device.device, image, format.format),
                          vk::raii::Semaphore(device.device, vk::SemaphoreCreateInfo{})});
    stale = false;
    return true;
}

// Whether a swapchain that is called suboptimal would come out different.
bool Presenter::State::size_changed() const {
    const vk::Extent2D now = device.physical.getSurfaceCapabilitiesKHR(*surface).currentExtent;
    return now != extent && now.width != std::numeric_limits<std::uint32_t>::max();
}

FrameTarget Presenter::State::target(std::uint32_t image) const {
    return {.image = images[image].image,
            .view = *images[image].view,
            .format = format.format,
            .extent = extent,
            .transfer_destination = copies,
            .final_layout = vk::ImageLayout::ePresentSrcKHR};
}

Presenter::Outcome Presenter::State::present() {
    wait(device, done);  // the last frame's slot is free again
    const FrameSlot* frame = recorder.exchange.take();
    if (!frame) return Outcome::hidden;
    if (stale && !rebuild()) return Outcome::hidden;

    std::uint32_t image = 0;
    try {
        const auto [result, index] = swapchain.acquireNextImage(std::numeric_limits<std::uint64_t>::max(), *acquired);
        if (result == vk::Result::eSuboptimalKHR) stale = size_changed();  // this frame still goes out
        image = index;
    } catch (const vk::OutOfDateKHRError&) {
        stale = true;
        return Outcome::again;
    }

    device.device.resetFences(*done);
    commands.begin({.flags = vk::CommandBufferUsageFlagBits::eOneTimeSubmit});
    recorder.record(commands, *frame, target(image));
    commands.end();
    const vk::SemaphoreSubmitInfo awaited{
        .semaphore = *acquired,
        .stageMask = vk::PipelineStageFlagBits2::eAllTransfer | vk::PipelineStageFlagBits2::eColorAttachmentOutput};
    const vk::SemaphoreSubmitInfo signalled{.semaphore = *images[image].rendered,
                                            .stageMask = vk::PipelineStageFlagBits2::eAllCommands};
    const vk::CommandBufferSubmitInfo buffer{.commandBuffer = *commands};
    device.queue.submit2(vk::SubmitInfo2{.waitSemaphoreInfoCount = 1,
                                         .pWaitSemaphoreInfos = &awaited,
                                         .commandBufferInfoCount = 1,
                                         .pCommandBufferInfos = &buffer,
                                         .signalSemaphoreInfoCount = 1,
                                         .pSignalSemaphoreInfos = &signalled},
                         *done);
    shown = frame->info;

    const vk::Semaphore rendered = *images[image].rendered;
    const vk::SwapchainKHR chain = *swapchain;
    try {
        const auto result = device.queue.presentKHR({.waitSemaphoreCount = 1,
                                                     .pWaitSemaphores = &rendered,
                                                     .swapchainCount = 1,
                                                     .pSwapchains = &chain,
                                                     .pImageIndices = &image});
        if (result == vk::Result::eSuboptimalKHR) stale = size_changed();
    } catch (const vk::OutOfDateKHRError&) {
        stale = true;
    }
    return stale ? Outcome::again : Outcome::shown;
}

Presenter::Presenter(GLFWwindow* window) : state_(std::make_unique<State>(window)) {}
Presenter::~Presenter() = default;
FrameExchange& Presenter::exchange() { return state_->recorder.exchange; }
FrameContent Presenter::preferred_content() const { return state_->recorder.preferred_content(); }
const std::string& Presenter::device_name() const { return state_->device.name; }
const FrameInfo& Presenter::shown_frame() const { return state_->shown; }
void Presenter::resized() { state_->stale = true; }
Presenter::Outcome Presenter::present() {
    return with_device_errors(state_->device, [&] { return state_->present(); });
}
void Presenter::warm_up() {
    with_device_errors(state_->device, [&] {
        if (state_->format.format != vk::Format::eUndefined) state_->recorder.warm_up(state_->format.format);
    });
}

// ---- memory ----

struct OffscreenPresenter::State {
    State()
        : instance(make_instance({})),
          device(make_device(instance, nullptr)),
          recorder(device),
          pool(make_command_pool(device)),
          commands(make_commands(device, pool)),
          done(device.device, vk::FenceCreateInfo{}) {}

    void prepare(vk::Extent2D extent);
    std::vector<std::uint32_t> present(vk::Extent2D extent);

    VulkanInstance instance;
    VulkanDevice device;
    FrameRecorder recorder;
    vk::raii::CommandPool pool;
    vk::raii::CommandBuffer commands;
    vk::raii::Fence done;
    VulkanImage image;
    VulkanBuffer readback;
    FramePath path = FramePath::copy;
};

void OffscreenPresenter::State::prepare(vk::Extent2D extent) {
    if (image.extent == extent) return;
    image = {};
    image = make_image(device, extent, offscreen_format,
                       vk::ImageUsageFlagBits::eTransferDst | vk::ImageUsageFlagBits::eTransferSrc |
                           vk::ImageUsageFlagBits::eColorAttachment);
    readback = {};
    readback =
        make_buffer(device, vk::DeviceSize{4} * extent.width * extent.height, vk::BufferUsageFlagBits::eTransferDst,
                    vk::MemoryPropertyFlagBits::eHostVisible | vk::MemoryPropertyFlagBits::eHostCoherent,
                    vk::MemoryPropertyFlagBits::eHostCached);
}

std::vector<std::uint32_t> OffscreenPresenter::State::present(vk::Extent2D extent) {
    const FrameSlot* frame = recorder.exchange.take();
    if (!frame) throw WorkError("no frame was traced");
    prepare(extent);

    commands.begin({.flags = vk::CommandBufferUsageFlagBits::eOneTimeSubmit});
    path = recorder.record(commands, *frame,
                           {.image = *image.image,
                            .view = *image.view,
                            .format = offscreen_format,
                            .extent = extent,
                            .final_layout = vk::ImageLayout::eTransferSrcOptimal});
    commands.copyImageToBuffer(*image.image, vk::ImageLayout::eTransferSrcOptimal, *readback.buffer,
                               vk::BufferImageCopy{.imageSubresource = {vk::ImageAspectFlagBits::eColor, 0, 0, 1},
                                                   .imageExtent = {extent.width, extent.height, 1}});
    const vk::MemoryBarrier2 to_host{.srcStageMask = vk::PipelineStageFlagBits2::eAllTransfer,
                                     .srcAccessMask = vk::AccessFlagBits2::eTransferWrite,
                                     .dstStageMask = vk::PipelineStageFlagBits2::eHost,
                                     .dstAccessMask = vk::AccessFlagBits2::eHostRead};
    commands.pipelineBarrier2(vk::DependencyInfo{.memoryBarrierCount = 1, .pMemoryBarriers = &to_host});
    commands.end();
    const vk::CommandBufferSubmitInfo buffer{.commandBuffer = *commands};
    device.queue.submit2(vk::SubmitInfo2{.commandBufferInfoCount = 1, .pCommandBufferInfos = &buffer}, *done);
    wait(device, done);
    device.device.resetFences(*done);

    std::vector<std::uint32_t> pixels(std::size_t{extent.width} * extent.height);
    std::memcpy(pixels.data(), readback.data, pixels.size() * sizeof pixels[0]);
    return pixels;
}

OffscreenPresenter::OffscreenPresenter() : state_(std::make_unique<State>()) {}
OffscreenPresenter::~OffscreenPresenter() = default;
FrameExchange& OffscreenPresenter::exchange() { return state_->recorder.exchange; }
FrameContent OffscreenPresenter::preferred_content() const { return state_->recorder.preferred_content(); }
const std::string& OffscreenPresenter::device_name() const { return state_->device.name; }
FramePath OffscreenPresenter::last_path() const { return state_->path; }
std::vector<std::uint32_t> OffscreenPresenter::present(int width, int height) {
    return with_device_errors(state_->device, [&] {
        return state_->present({static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height)});
    });
}

}  // namespace raywalk
