#include "app/report/pictures.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "app/cli/camera_options.h"
#include "app/cli/gpu_options.h"
#include "app/report/html.h"
#include "renderer/draw/png.h"
#include "renderer/draw/renderer.h"
#include "renderer/vk/device_error.h"

namespace lacedring::app {
namespace {

/// Samples along each side of a pixel.
std::uint32_t report_samples(const gpu::Context& context, const PictureSize& size) {
    return gpu::Target::fitting_samples(context, {size.width, size.height}, 3);
}

Result<ReportPicture> draw_view(gpu::Context& context, const PictureSize& size, const gpu::CameraOptions& from,
                                const gpu::Model& model, gpu::View view) {
    gpu::RendererOptions options;
    options.view = view;
    options.samples = report_samples(context, size);
    options.width = size.width * options.samples;
    options.height = size.height * options.samples;
    Result<gpu::Renderer> renderer = gpu::Renderer::create(context, options);
    if (!renderer) return renderer.error();
    Result<gpu::Drawable> drawable = renderer->upload(model, gpu::Source::lean);
    if (!drawable) return drawable.error();
    const Result<gpu::Camera> camera = gpu::make_camera(model, from, options.width, options.height);
    if (!camera) return camera.error();
    const Result<gpu::Picture> drawn = renderer->draw(*drawable, model, *camera, true);
    if (!drawn) return drawn.error();
    const Result<std::vector<std::byte>> png = gpu::encode_png(gpu::finish(*drawn, options.samples));
    if (!png) return png.error();
    return ReportPicture{"", size.width, size.height, png_uri(*png)};
}

}  // namespace

struct ReportPictures::Drawer {
    bool off = false;
    PictureSize size{960, 720};
    gpu::CameraOptions camera;  ///< the same for every mesh
    gpu::ContextOptions options;
    std::unique_ptr<gpu::Context> context;  ///< null: no pictures
};

ReportPictures::ReportPictures() : drawer_(std::make_unique<Drawer>()) {}
ReportPictures::~ReportPictures() = default;

void ReportPictures::add_options(CLI::App& command) {
    command.add_flag("--no-gpu", drawer_->off, "draw no pictures");
    add_size(command, drawer_->size);
    add_camera(command, drawer_->camera);
    add_device_options(command, drawer_->options);
}

Result<ReportPictures::Device> ReportPictures::open() {
    if (drawer_->off) return Device{"", 0, "--no-gpu"};
    Result<std::unique_ptr<gpu::Context>> context = gpu::Context::create(drawer_->options);
    if (!context && context.error().code == gpu::kNoDevice && !asks_for_device(drawer_->options)) {
        return Device{"", 0, context.error().message};
    }
    if (!context) return context.error();
    drawer_->context = std::move(*context);
    const gpu::DeviceInfo& info = drawer_->context->info();
    const std::uint32_t samples = report_samples(*drawer_->context, drawer_->size);
    return Device{fmt::format("{}, {}, Vulkan {}", info.name, info.driver, info.api), samples * samples, ""};
}

std::size_t ReportPictures::print_messages() const {
    return drawer_->context ? print_validation(*drawer_->context) : 0;
}

Result<void> ReportPictures::draw(const LoadedMesh& loaded, const RingChoice& choice, MeshReport& report) const {
    if (!drawer_->context) return {};
    // The same options, and so the same lean stream, as in the table of sizes.
    const Mesh& mesh = loaded.mesh;
    const Result<gpu::Model> model = gpu::make_model(mesh, {.ring = ring_options(choice, mesh.triangle_count()),
                                                            .optimize = optimize_options(choice, kLeanRingCost),
                                                            .surface = loaded.surface});
    if (!model) {
        report.no_pictures = model.error().message;
        return {};
    }
    for (const char* name : {"smooth", "class", "ring"}) {
        Result<ReportPicture> picture =
            draw_view(*drawer_->context, drawer_->size, drawer_->camera, *model, *gpu::find_named(gpu::kViews, name));
        if (!picture) {
            const ErrorCode code = picture.error().code;
            if (code == gpu::kDeviceFailure || code == ErrorCode::invalid_argument) return picture.error();
            report.pictures.clear();
            report.no_pictures = picture.error().message;
            return {};
        }
        picture->view = name;
        report.pictures.push_back(std::move(*picture));
    }
    return {};
}

}  // namespace lacedring::app
