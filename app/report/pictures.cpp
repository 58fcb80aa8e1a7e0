#include "app/report/pictures.h"

#include "app/report/html.h"
#include "renderer/draw/png.h"
#include "renderer/draw/renderer.h"
#include "renderer/vk/device_error.h"

namespace lacedring::app {
namespace {

Result<ReportPicture> draw(gpu::Context& context, const PictureSize& size, const gpu::CameraOptions& from,
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

std::uint32_t report_samples(const gpu::Context& context, const PictureSize& size) {
    return gpu::Target::fitting_samples(context, {size.width, size.height}, 3);
}

Result<void> draw_pictures(gpu::Context& context, const PictureSize& size, const gpu::CameraOptions& camera,
                           const LoadedMesh& loaded, const RingChoice& choice, MeshReport& report) {
    // With the very stream that the size table is of.
    const Mesh& mesh = loaded.mesh;
    const Result<gpu::Model> model = gpu::make_model(mesh, {.ring = ring_options(choice, mesh.triangle_count()),
                                                            .optimize = optimize_options(choice, kLeanRingCost),
                                                            .surface = loaded.surface});
    if (!model) {
        report.no_pictures = model.error().message;
        return {};
    }
    for (const char* name : {"smooth", "class", "ring"}) {
        Result<ReportPicture> picture = draw(context, size, camera, *model, *gpu::find_named(gpu::kViews, name));
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
