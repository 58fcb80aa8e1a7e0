#include "app/view/window/overlay.h"

#include <backends/imgui_impl_vulkan.h>
#include <imgui.h>

#include <array>
#include <filesystem>

#include "app/view/window/theme.h"
#include "renderer/draw/target.h"
#include "renderer/vk/context.h"
#include "renderer/vk/device_error.h"
#include "renderer/vk/try.h"

namespace lacedring::view {
namespace {

using gpu::Access;

constexpr Access kDrawn{VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT,
                        VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT | VK_ACCESS_2_COLOR_ATTACHMENT_READ_BIT};
constexpr Access kCopyWrite{VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT};
constexpr Access kCopyRead{VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_READ_BIT};

Result<gpu::RenderPassHandle> create_pass(gpu::Context& context) {
    VkAttachmentDescription attachment{};
    attachment.format = gpu::Target::kColor;
    attachment.samples = VK_SAMPLE_COUNT_1_BIT;
    attachment.loadOp = VK_ATTACHMENT_LOAD_OP_LOAD;
    attachment.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
    attachment.stencilLoadOp = VK_ATTACHMENT_LOAD_OP_DONT_CARE;
    attachment.stencilStoreOp = VK_ATTACHMENT_STORE_OP_DONT_CARE;
    attachment.initialLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
    attachment.finalLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
    const VkAttachmentReference reference{0, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
    VkSubpassDescription subpass{};
    subpass.pipelineBindPoint = VK_PIPELINE_BIND_POINT_GRAPHICS;
    subpass.colorAttachmentCount = 1;
    subpass.pColorAttachments = &reference;
    VkRenderPassCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO;
    info.attachmentCount = 1;
    info.pAttachments = &attachment;
    info.subpassCount = 1;
    info.pSubpasses = &subpass;
    VkRenderPass pass = VK_NULL_HANDLE;
    LR_TRY_VK(vkCreateRenderPass(context.device(), &info, nullptr, &pass));
    return gpu::RenderPassHandle(context.device(), pass);
}

Result<gpu::DescriptorPoolHandle> create_pool(gpu::Context& context) {
    const VkDescriptorPoolSize size{VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 4};
    VkDescriptorPoolCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO;
    info.flags = VK_DESCRIPTOR_POOL_CREATE_FREE_DESCRIPTOR_SET_BIT;
    info.maxSets = 4;
    info.poolSizeCount = 1;
    info.pPoolSizes = &size;
    VkDescriptorPool pool = VK_NULL_HANDLE;
    LR_TRY_VK(vkCreateDescriptorPool(context.device(), &info, nullptr, &pool));
    return gpu::DescriptorPoolHandle(context.device(), pool);
}

}  // namespace

Result<std::unique_ptr<Overlay>> Overlay::create(gpu::Context& context, double scale) {
    std::unique_ptr<Overlay> out(new Overlay);
    out->context_ = &context;
    IMGUI_CHECKVERSION();
    ImGui::CreateContext();
    LR_TRY(out->start(context, scale));
    return out;
}

Result<void> Overlay::start(gpu::Context& context, double scale) {
    ImGuiIO& io = ImGui::GetIO();
    io.IniFilename = nullptr;  // panels have fixed places
    io.LogFilename = nullptr;
    for (int i = 0; i < ImGuiKey_COUNT; ++i) io.KeyMap[i] = -1;
    constexpr std::array<std::pair<ImGuiKey, int>, 15> kMap{{{ImGuiKey_Tab, key_tab},
                                                             {ImGuiKey_LeftArrow, key_left},
                                                             {ImGuiKey_RightArrow, key_right},
                                                             {ImGuiKey_UpArrow, key_up},
                                                             {ImGuiKey_DownArrow, key_down},
                                                             {ImGuiKey_Home, key_home},
                                                             {ImGuiKey_End, key_end},
                                                             {ImGuiKey_Delete, key_delete},
                                                             {ImGuiKey_Backspace, key_backspace},
                                                             {ImGuiKey_Enter, key_enter},
                                                             {ImGuiKey_Escape, key_escape},
                                                             {ImGuiKey_A, 'A'},
                                                             {ImGuiKey_C, 'C'},
                                                             {ImGuiKey_V, 'V'},
                                                             {ImGuiKey_X, 'X'}}};
    for (const auto& [key, code] : kMap) io.KeyMap[key] = code;
    apply_theme(static_cast<float>(scale));

    LR_ASSIGN(pass_, create_pass(context));
    LR_ASSIGN(pool_, create_pool(context));
    ImGui_ImplVulkan_InitInfo info{};
    info.Instance = context.instance();
    info.PhysicalDevice = context.physical();
    info.Device = context.device();
    info.QueueFamily = context.queue_family();
    info.Queue = context.queue();
    info.DescriptorPool = pool_.get();
    info.MinImageCount = 2;
    info.ImageCount = 2;
    info.MSAASamples = VK_SAMPLE_COUNT_1_BIT;
    if (!ImGui_ImplVulkan_Init(&info, pass_.get())) return Error{gpu::kDeviceFailure, "ImGui's Vulkan backend"};
    started_ = true;
    LR_ASSIGN(gpu::Commands commands, gpu::Commands::create(context));
    LR_ASSIGN(const VkCommandBuffer buffer, commands.begin());
    ImGui_ImplVulkan_CreateFontsTexture(buffer);
    LR_TRY(commands.run());
    ImGui_ImplVulkan_DestroyFontUploadObjects();
    return {};
}

Overlay::~Overlay() {
    context_->wait_idle();
    if (started_) ImGui_ImplVulkan_Shutdown();
    ImGui::DestroyContext();
}

Result<void> Overlay::resize(VkExtent2D extent) {
    framebuffer_ = {};
    extent_ = extent;
    LR_ASSIGN(image_, gpu::Image::create(*context_, "window", extent, gpu::Target::kColor,
                                         VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT |
                                             VK_IMAGE_USAGE_TRANSFER_SRC_BIT));
    const VkImageView view = image_.view();
    VkFramebufferCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO;
    info.renderPass = pass_.get();
    info.attachmentCount = 1;
    info.pAttachments = &view;
    info.width = extent.width;
    info.height = extent.height;
    info.layers = 1;
    VkFramebuffer framebuffer = VK_NULL_HANDLE;
    LR_TRY_VK(vkCreateFramebuffer(context_->device(), &info, nullptr, &framebuffer));
    framebuffer_ = {context_->device(), framebuffer};
    return {};
}

void Overlay::feed(const Event& event) {
    ImGuiIO& io = ImGui::GetIO();
    switch (event.kind) {
        case Event::move:
            io.MousePos = {static_cast<float>(event.x), static_cast<float>(event.y)};
            break;
        case Event::button:
            io.MousePos = {static_cast<float>(event.x), static_cast<float>(event.y)};
            if (event.code >= 0 && event.code < 5) io.MouseDown[event.code] = event.down;
            break;
        case Event::scroll:
            io.MouseWheel += static_cast<float>(event.y);
            io.MouseWheelH += static_cast<float>(event.x);
            break;
        case Event::key:
            if (event.code >= 0 && event.code < 512) io.KeysDown[event.code] = event.down;
            io.KeyShift = (event.modifiers & mod_shift) != 0;
            io.KeyCtrl = (event.modifiers & mod_control) != 0;
            io.KeyAlt = (event.modifiers & mod_alt) != 0;
            break;
        case Event::text:
            io.AddInputCharacter(static_cast<unsigned>(event.code));
            break;
        default:
            break;
    }
}

void Overlay::record(VkCommandBuffer commands, const gpu::Image& under) {
    constexpr VkImageAspectFlags kAspect = VK_IMAGE_ASPECT_COLOR_BIT;
    gpu::image_barrier(commands, image_.handle(), kAspect, kCopyRead, kCopyWrite, VK_IMAGE_LAYOUT_UNDEFINED,
                       VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
    VkImageCopy region{};
    region.srcSubresource = {kAspect, 0, 0, 1};
    region.dstSubresource = {kAspect, 0, 0, 1};
    region.extent = {extent_.width, extent_.height, 1};
    vkCmdCopyImage(commands, under.handle(), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, image_.handle(),
                   VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &region);
    gpu::image_barrier(commands, image_.handle(), kAspect, kCopyWrite, kDrawn, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                       VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL);
    VkRenderPassBeginInfo begin{};
    begin.sType = VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO;
    begin.renderPass = pass_.get();
    begin.framebuffer = framebuffer_.get();
    begin.renderArea = {{0, 0}, extent_};
    vkCmdBeginRenderPass(commands, &begin, VK_SUBPASS_CONTENTS_INLINE);
    ImGui_ImplVulkan_RenderDrawData(ImGui::GetDrawData(), commands);
    vkCmdEndRenderPass(commands);
    gpu::image_barrier(commands, image_.handle(), kAspect, kDrawn, kCopyRead, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                       VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
}

}  // namespace lacedring::view
