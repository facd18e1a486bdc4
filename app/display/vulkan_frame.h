// The commands that bring a frame from its staging slot into an image: one way for windows and for images in memory.
#pragma once

#include <array>
#include <map>
#include <optional>

#include "app/display/frame_exchange.h"
#include "app/display/presenter.h"
#include "app/display/vulkan_device.h"

namespace raywalk {

// What a frame is drawn into.
struct FrameTarget {
    vk::Image image;
    vk::ImageView view;
    vk::Format format;
    vk::Extent2D extent;
    bool transfer_destination = true;  // the image takes copies
    vk::ImageLayout final_layout;      // ePresentSrcKHR or eTransferSrcOptimal
};

// What a fragment shader reads: one descriptor, and constants if it has some.
struct ShaderPass {
    vk::DescriptorType type;
    vk::raii::DescriptorSetLayout set_layout{nullptr};
    vk::raii::DescriptorSet set{nullptr};
    vk::raii::PipelineLayout layout{nullptr};
};

// One frame at a time: before record() or a new take() from exchange(), the commands recorded last are done.
class FrameRecorder {
  public:
    explicit FrameRecorder(const VulkanDevice& device);

    FrameExchange exchange;

    [[nodiscard]] FrameContent preferred_content() const { return preferred_content_; }
    FramePath record(const vk::raii::CommandBuffer& commands, const FrameSlot& slot, const FrameTarget& target);
    // Compiles the pipelines that frames of other sizes need.
    void warm_up(vk::Format target_format);

  private:
    void grow(FrameSlot& slot, std::size_t bytes);
    void prepare_source(vk::Extent2D extent);
    void upload_picture(const vk::raii::CommandBuffer& commands, const FrameSlot& slot);
    void upload_tiles(const vk::raii::CommandBuffer& commands, const FrameSlot& slot, vk::DeviceSize bytes);
    void resolve(const vk::raii::CommandBuffer& commands, const FrameSlot& slot, vk::ImageView view,
                 vk::Extent2D extent);
    void scale(const vk::raii::CommandBuffer& commands, const FrameTarget& target);
    vk::raii::Pipeline make_pipeline(std::span<const std::uint32_t> fragment, const ShaderPass& pass,
                                     vk::Format format) const;
    const vk::raii::Pipeline& scale_pipeline(vk::Format format);
    const vk::raii::Pipeline& resolve_pipeline();

    const VulkanDevice* device_;
    FrameContent preferred_content_;
    std::array<VulkanBuffer, 3> staging_;  // by FrameSlot::index; each belongs to the owner of the slot
    VulkanImage source_;                   // the frame at its own size, for the scaling pass to read
    VulkanBuffer tiles_;                   // the film's tiles on the device, for the resolving pass to read
    vk::raii::Sampler sampler_{nullptr};
    vk::raii::DescriptorPool pool_{nullptr};
    ShaderPass scale_pass_, resolve_pass_;
    std::map<vk::Format, vk::raii::Pipeline> scale_pipelines_;
    std::optional<vk::raii::Pipeline> resolve_pipeline_;
};

void transition(const vk::raii::CommandBuffer& commands, const vk::ImageMemoryBarrier2& barrier);

}  // namespace raywalk
