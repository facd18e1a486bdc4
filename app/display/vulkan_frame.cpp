#include "app/display/vulkan_frame.h"

#include <cstdlib>
#include <string_view>

#include "app/display/fit.h"
#include "shaders/picture_vert.h"
#include "shaders/resolve_frag.h"
#include "shaders/scale_frag.h"
#include "tracer/ground/error.h"
#include "tracer/picture/film.h"

namespace raywalk {
namespace {

using Stage = vk::PipelineStageFlagBits2;
using Access = vk::AccessFlagBits2;
using Layout = vk::ImageLayout;

constexpr vk::Format frame_format = vk::Format::eB8G8R8A8Unorm;
constexpr vk::ImageSubresourceRange whole_color{vk::ImageAspectFlagBits::eColor, 0, 1, 0, 1};

struct ResolveConstants {
    std::int32_t tiles_x, tile_count;
};

bool is_srgb(vk::Format format) {
    return format == vk::Format::eB8G8R8A8Srgb || format == vk::Format::eR8G8B8A8Srgb ||
           format == vk::Format::eA8B8G8R8SrgbPack32;
}

// A discrete device resolves radiance itself and leaves the processor to the tracer; elsewhere the processor does both
// and so writes display values. RAYWALK_RESOLVE=device|processor decides otherwise.
FrameContent preferred_content_of(const VulkanDevice& device) {
    if (const char* choice = std::getenv("RAYWALK_RESOLVE")) {
        if (std::string_view(choice) == "device") return FrameContent::radiance;
        if (std::string_view(choice) == "processor") return FrameContent::display;
    }
    return device.type == vk::PhysicalDeviceType::eDiscreteGpu ? FrameContent::radiance : FrameContent::display;
}

int tiles_across(int pixels) { return (pixels + tile_size - 1) / tile_size; }

vk::Extent2D extent_of(const FrameInfo& info) {
    return {static_cast<std::uint32_t>(info.width), static_cast<std::uint32_t>(info.height)};
}

void copy_to_image(const vk::raii::CommandBuffer& commands, vk::Buffer buffer, vk::Image image, vk::Extent2D extent) {
    commands.copyBufferToImage(buffer, image, Layout::eTransferDstOptimal,
                               vk::BufferImageCopy{.imageSubresource = {vk::ImageAspectFlagBits::eColor, 0, 0, 1},
                                                   .imageExtent = {extent.width, extent.height, 1}});
}

// A set of its own for each pass: lavapipe 22.3 crashes on a set of which one descriptor was never written, although
// the shader does not use it.
ShaderPass make_pass(const vk::raii::Device& device, const vk::raii::DescriptorPool& pool, vk::DescriptorType type,
                     std::uint32_t constant_bytes) {
    ShaderPass pass{.type = type};
    const vk::DescriptorSetLayoutBinding binding{
        .binding = 0, .descriptorType = type, .descriptorCount = 1, .stageFlags = vk::ShaderStageFlagBits::eFragment};
    pass.set_layout = {device, vk::DescriptorSetLayoutCreateInfo{.bindingCount = 1, .pBindings = &binding}};
    const vk::DescriptorSetLayout set_layout = *pass.set_layout;
    pass.set = std::move(vk::raii::DescriptorSets(device, vk::DescriptorSetAllocateInfo{.descriptorPool = *pool,
                                                                                        .descriptorSetCount = 1,
                                                                                        .pSetLayouts = &set_layout})
                             .front());
    const vk::PushConstantRange constants{vk::ShaderStageFlagBits::eFragment, 0, constant_bytes};
    pass.layout = {device, vk::PipelineLayoutCreateInfo{.setLayoutCount = 1,
                                                        .pSetLayouts = &set_layout,
                                                        .pushConstantRangeCount = constant_bytes ? 1u : 0u,
                                                        .pPushConstantRanges = &constants}};
    return pass;
}

void write_descriptor(const vk::raii::Device& device, const ShaderPass& pass, const vk::DescriptorImageInfo* image,
                      const vk::DescriptorBufferInfo* buffer) {
    device.updateDescriptorSets(vk::WriteDescriptorSet{.dstSet = *pass.set,
                                                       .descriptorCount = 1,
                                                       .descriptorType = pass.type,
                                                       .pImageInfo = image,
                                                       .pBufferInfo = buffer},
                                {});
}

}  // namespace

void transition(const vk::raii::CommandBuffer& commands, const vk::ImageMemoryBarrier2& barrier) {
    vk::ImageMemoryBarrier2 whole = barrier;
    whole.srcQueueFamilyIndex = whole.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
    whole.subresourceRange = whole_color;
    commands.pipelineBarrier2(vk::DependencyInfo{.imageMemoryBarrierCount = 1, .pImageMemoryBarriers = &whole});
}

FrameRecorder::FrameRecorder(const VulkanDevice& device)
    : exchange([this](FrameSlot& slot, std::size_t bytes) { grow(slot, bytes); }),
      device_(&device),
      preferred_content_(preferred_content_of(device)) {
    sampler_ = {device.device, vk::SamplerCreateInfo{.magFilter = vk::Filter::eLinear,
                                                     .minFilter = vk::Filter::eLinear,
                                                     .addressModeU = vk::SamplerAddressMode::eClampToEdge,
                                                     .addressModeV = vk::SamplerAddressMode::eClampToEdge,
                                                     .addressModeW = vk::SamplerAddressMode::eClampToEdge}};
    const vk::DescriptorPoolSize sizes[] = {{vk::DescriptorType::eCombinedImageSampler, 1},
                                            {vk::DescriptorType::eStorageBuffer, 1}};
    pool_ = {device.device, vk::DescriptorPoolCreateInfo{.flags = vk::DescriptorPoolCreateFlagBits::eFreeDescriptorSet,
                                                         .maxSets = 2,
                                                         .poolSizeCount = 2,
                                                         .pPoolSizes = sizes}};
    scale_pass_ = make_pass(device.device, pool_, vk::DescriptorType::eCombinedImageSampler, 0);
    resolve_pass_ = make_pass(device.device, pool_, vk::DescriptorType::eStorageBuffer, sizeof(ResolveConstants));
}

// Called by the thread that owns the slot; the device has no more use for the old buffer then.
void FrameRecorder::grow(FrameSlot& slot, std::size_t bytes) {
    staging_[slot.index] = {};
    staging_[slot.index] =
        make_buffer(*device_, bytes, vk::BufferUsageFlagBits::eTransferSrc,
                    vk::MemoryPropertyFlagBits::eHostVisible | vk::MemoryPropertyFlagBits::eHostCoherent);
    slot.data = static_cast<std::byte*>(staging_[slot.index].data);
    slot.capacity = bytes;
}

FramePath FrameRecorder::record(const vk::raii::CommandBuffer& commands, const FrameSlot& slot,
                                const FrameTarget& target) {
    const FrameInfo& info = slot.info;
    const bool fits = extent_of(info) == target.extent && target.format == frame_format;
    const bool radiance = info.content == FrameContent::radiance;
    const bool copy = fits && !radiance && target.transfer_destination;

    // The old content of the target is of no use; the stages are those at which the swapchain's semaphore is awaited.
    transition(commands, {.srcStageMask = Stage::eAllTransfer | Stage::eColorAttachmentOutput,
                          .dstStageMask = copy ? Stage::eAllTransfer : Stage::eColorAttachmentOutput,
                          .dstAccessMask = copy ? Access::eTransferWrite
                                                : Access::eColorAttachmentWrite | Access::eColorAttachmentRead,
                          .oldLayout = Layout::eUndefined,
                          .newLayout = copy ? Layout::eTransferDstOptimal : Layout::eColorAttachmentOptimal,
                          .image = target.image});
    FramePath path = FramePath::copy;
    if (copy) {
        copy_to_image(commands, *staging_[slot.index].buffer, target.image, target.extent);
    } else if (radiance && fits) {
        resolve(commands, slot, target.view, target.extent);
        path = FramePath::resolve;
    } else {
        prepare_source(extent_of(info));
        if (radiance) {
            transition(commands, {.srcStageMask = Stage::eFragmentShader,
                                  .dstStageMask = Stage::eColorAttachmentOutput,
                                  .dstAccessMask = Access::eColorAttachmentWrite | Access::eColorAttachmentRead,
                                  .oldLayout = Layout::eUndefined,
                                  .newLayout = Layout::eColorAttachmentOptimal,
                                  .image = *source_.image});
            resolve(commands, slot, *source_.view, source_.extent);
            transition(commands, {.srcStageMask = Stage::eColorAttachmentOutput,
                                  .srcAccessMask = Access::eColorAttachmentWrite,
                                  .dstStageMask = Stage::eFragmentShader,
                                  .dstAccessMask = Access::eShaderSampledRead,
                                  .oldLayout = Layout::eColorAttachmentOptimal,
                                  .newLayout = Layout::eShaderReadOnlyOptimal,
                                  .image = *source_.image});
        } else {
            upload_picture(commands, slot);
        }
        scale(commands, target);
        path = radiance ? FramePath::resolve_and_scale : FramePath::scale;
    }
    const bool read_back = target.final_layout == Layout::eTransferSrcOptimal;
    transition(commands, {.srcStageMask = copy ? Stage::eAllTransfer : Stage::eColorAttachmentOutput,
                          .srcAccessMask = copy ? Access::eTransferWrite : Access::eColorAttachmentWrite,
                          .dstStageMask = read_back ? Stage::eAllTransfer : Stage::eNone,
                          .dstAccessMask = read_back ? Access::eTransferRead : Access::eNone,
                          .oldLayout = copy ? Layout::eTransferDstOptimal : Layout::eColorAttachmentOptimal,
                          .newLayout = target.final_layout,
                          .image = target.image});
    return path;
}

void FrameRecorder::prepare_source(vk::Extent2D extent) {
    if (source_.extent == extent) return;
    source_ = {};
    source_ = make_image(*device_, extent, frame_format,
                         vk::ImageUsageFlagBits::eSampled | vk::ImageUsageFlagBits::eTransferDst |
                             vk::ImageUsageFlagBits::eColorAttachment);
    const vk::DescriptorImageInfo image{*sampler_, *source_.view, Layout::eShaderReadOnlyOptimal};
    write_descriptor(device_->device, scale_pass_, &image, nullptr);
}

void FrameRecorder::upload_picture(const vk::raii::CommandBuffer& commands, const FrameSlot& slot) {
    transition(commands, {.srcStageMask = Stage::eFragmentShader,
                          .dstStageMask = Stage::eAllTransfer,
                          .dstAccessMask = Access::eTransferWrite,
                          .oldLayout = Layout::eUndefined,
                          .newLayout = Layout::eTransferDstOptimal,
                          .image = *source_.image});
    copy_to_image(commands, *staging_[slot.index].buffer, *source_.image, source_.extent);
    transition(commands, {.srcStageMask = Stage::eAllTransfer,
                          .srcAccessMask = Access::eTransferWrite,
                          .dstStageMask = Stage::eFragmentShader,
                          .dstAccessMask = Access::eShaderSampledRead,
                          .oldLayout = Layout::eTransferDstOptimal,
                          .newLayout = Layout::eShaderReadOnlyOptimal,
                          .image = *source_.image});
}

void FrameRecorder::upload_tiles(const vk::raii::CommandBuffer& commands, const FrameSlot& slot, vk::DeviceSize bytes) {
    if (tiles_.size < bytes) {
        tiles_ = {};
        tiles_ = make_buffer(*device_, bytes,
                             vk::BufferUsageFlagBits::eTransferDst | vk::BufferUsageFlagBits::eStorageBuffer,
                             vk::MemoryPropertyFlagBits::eDeviceLocal);
        const vk::DescriptorBufferInfo buffer{*tiles_.buffer, 0, VK_WHOLE_SIZE};
        write_descriptor(device_->device, resolve_pass_, nullptr, &buffer);
    }
    const auto fence_tiles = [&](Stage from, vk::AccessFlags2 written, Stage to, Access access) {
        const vk::BufferMemoryBarrier2 barrier{.srcStageMask = from,
                                               .srcAccessMask = written,
                                               .dstStageMask = to,
                                               .dstAccessMask = access,
                                               .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
                                               .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
                                               .buffer = *tiles_.buffer,
                                               .size = VK_WHOLE_SIZE};
        commands.pipelineBarrier2(vk::DependencyInfo{.bufferMemoryBarrierCount = 1, .pBufferMemoryBarriers = &barrier});
    };
    fence_tiles(Stage::eFragmentShader, {}, Stage::eAllTransfer, Access::eTransferWrite);
    commands.copyBuffer(*staging_[slot.index].buffer, *tiles_.buffer, vk::BufferCopy{.size = bytes});
    fence_tiles(Stage::eAllTransfer, Access::eTransferWrite, Stage::eFragmentShader, Access::eShaderStorageRead);
}

namespace {

void draw(const vk::raii::CommandBuffer& commands, vk::Pipeline pipeline, const ShaderPass& pass, vk::ImageView view,
          vk::Extent2D extent, const Rectangle& where) {
    const vk::RenderingAttachmentInfo color{.imageView = view,
                                            .imageLayout = Layout::eColorAttachmentOptimal,
                                            .loadOp = vk::AttachmentLoadOp::eClear,
                                            .storeOp = vk::AttachmentStoreOp::eStore,
                                            .clearValue = vk::ClearColorValue(std::array{0.0f, 0.0f, 0.0f, 1.0f})};
    commands.beginRendering(
        {.renderArea = {{0, 0}, extent}, .layerCount = 1, .colorAttachmentCount = 1, .pColorAttachments = &color});
    commands.bindPipeline(vk::PipelineBindPoint::eGraphics, pipeline);
    commands.bindDescriptorSets(vk::PipelineBindPoint::eGraphics, *pass.layout, 0, *pass.set, {});
    commands.setViewport(0, vk::Viewport{static_cast<float>(where.x), static_cast<float>(where.y),
                                         static_cast<float>(where.width), static_cast<float>(where.height), 0, 1});
    commands.setScissor(
        0, vk::Rect2D{{where.x, where.y},
                      {static_cast<std::uint32_t>(where.width), static_cast<std::uint32_t>(where.height)}});
    commands.draw(3, 1, 0, 0);
    commands.endRendering();
}

}  // namespace

void FrameRecorder::resolve(const vk::raii::CommandBuffer& commands, const FrameSlot& slot, vk::ImageView view,
                            vk::Extent2D extent) {
    const int tiles_x = tiles_across(slot.info.width);
    const int tile_count = tiles_x * tiles_across(slot.info.height);
    upload_tiles(commands, slot, tile_count * (sizeof(FilmTile) + sizeof(float)));
    commands.pushConstants<ResolveConstants>(*resolve_pass_.layout, vk::ShaderStageFlagBits::eFragment, 0,
                                             ResolveConstants{tiles_x, tile_count});
    draw(commands, *resolve_pipeline(), resolve_pass_, view, extent, {0, 0, slot.info.width, slot.info.height});
}

void FrameRecorder::scale(const vk::raii::CommandBuffer& commands, const FrameTarget& target) {
    const Rectangle where = fit(static_cast<int>(source_.extent.width), static_cast<int>(source_.extent.height),
                                static_cast<int>(target.extent.width), static_cast<int>(target.extent.height));
    draw(commands, *scale_pipeline(target.format), scale_pass_, target.view, target.extent, where);
}

void FrameRecorder::warm_up(vk::Format target_format) {
    scale_pipeline(target_format);
    if (preferred_content_ == FrameContent::radiance) resolve_pipeline();
}

const vk::raii::Pipeline& FrameRecorder::scale_pipeline(vk::Format format) {
    auto found = scale_pipelines_.find(format);
    if (found == scale_pipelines_.end())
        found = scale_pipelines_.emplace(format, make_pipeline(scale_frag, scale_pass_, format)).first;
    return found->second;
}

const vk::raii::Pipeline& FrameRecorder::resolve_pipeline() {
    if (!resolve_pipeline_) resolve_pipeline_ = make_pipeline(resolve_frag, resolve_pass_, frame_format);
    return *resolve_pipeline_;
}

vk::raii::Pipeline FrameRecorder::make_pipeline(std::span<const std::uint32_t> fragment, const ShaderPass& pass,
                                                vk::Format format) const {
    const auto module = [&](std::span<const std::uint32_t> code) {
        return vk::raii::ShaderModule(device_->device,
                                      vk::ShaderModuleCreateInfo{.codeSize = code.size_bytes(), .pCode = code.data()});
    };
    const vk::raii::ShaderModule vertex_module = module(picture_vert), fragment_module = module(fragment);

    // scale.frag: nine taps a pixel are for devices that have the time.
    const struct {
        vk::Bool32 smooth_cubic, srgb_target;
    } constants{device_->type != vk::PhysicalDeviceType::eCpu, is_srgb(format)};
    const vk::SpecializationMapEntry entries[] = {{0, 0, sizeof(vk::Bool32)},
                                                  {1, sizeof(vk::Bool32), sizeof(vk::Bool32)}};
    const vk::SpecializationInfo specialization{2, entries, sizeof constants, &constants};

    const vk::PipelineShaderStageCreateInfo stages[] = {
        {.stage = vk::ShaderStageFlagBits::eVertex, .module = *vertex_module, .pName = "main"},
        {.stage = vk::ShaderStageFlagBits::eFragment,
         .module = *fragment_module,
         .pName = "main",
         .pSpecializationInfo = fragment.data() == scale_frag ? &specialization : nullptr},
    };
    const vk::PipelineVertexInputStateCreateInfo no_vertices;
    const vk::PipelineInputAssemblyStateCreateInfo triangles{.topology = vk::PrimitiveTopology::eTriangleList};
    const vk::PipelineViewportStateCreateInfo viewport{.viewportCount = 1, .scissorCount = 1};
    const vk::PipelineRasterizationStateCreateInfo rasterization{.lineWidth = 1};
    const vk::PipelineMultisampleStateCreateInfo one_sample{.rasterizationSamples = vk::SampleCountFlagBits::e1};
    const vk::PipelineColorBlendAttachmentState opaque{
        .colorWriteMask = vk::ColorComponentFlagBits::eR | vk::ColorComponentFlagBits::eG |
                          vk::ColorComponentFlagBits::eB | vk::ColorComponentFlagBits::eA};
    const vk::PipelineColorBlendStateCreateInfo blend{.attachmentCount = 1, .pAttachments = &opaque};
    const vk::DynamicState dynamic_states[] = {vk::DynamicState::eViewport, vk::DynamicState::eScissor};
    const vk::PipelineDynamicStateCreateInfo dynamic{.dynamicStateCount = 2, .pDynamicStates = dynamic_states};
    const vk::PipelineRenderingCreateInfo rendering{.colorAttachmentCount = 1, .pColorAttachmentFormats = &format};
    return {device_->device, nullptr,
            vk::GraphicsPipelineCreateInfo{.pNext = &rendering,
                                           .stageCount = 2,
                                           .pStages = stages,
                                           .pVertexInputState = &no_vertices,
                                           .pInputAssemblyState = &triangles,
                                           .pViewportState = &viewport,
                                           .pRasterizationState = &rasterization,
                                           .pMultisampleState = &one_sample,
                                           .pColorBlendState = &blend,
                                           .pDynamicState = &dynamic,
                                           .layout = *pass.layout}};
}

}  // namespace raywalk
