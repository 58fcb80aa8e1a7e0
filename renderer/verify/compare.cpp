#include "renderer/verify/compare.h"

#include <algorithm>
#include <array>

#include "lacedring/seams.hpp"
#include "lacedring/streams.hpp"
#include "lacedring/vertices.hpp"
#include "renderer/draw/renderer.h"
#include "renderer/vk/try.h"

namespace lacedring::gpu {
namespace {

constexpr std::uint32_t kViews = 6;
constexpr std::uint32_t kColumns = 3;

/// The six axes, tilted so that no face of a box is seen edge-on or head-on.
constexpr std::array<std::array<double, 3>, kViews> kDirections{{{1.0, 0.31, 0.23},
                                                                 {-1.0, 0.27, -0.34},
                                                                 {0.29, 1.0, 0.37},
                                                                 {-0.33, -1.0, 0.26},
                                                                 {0.36, 0.22, 1.0},
                                                                 {-0.24, 0.35, -1.0}}};

/// One byte per pixel: bit 0 if the exact pictures differ there, bit 1 if the raw ones do.
using Marks = std::vector<std::uint8_t>;

void mark(Marks& marks, const Picture& a, const Picture& b, std::uint8_t bit) {
    for (std::size_t i = 0; i < a.pixels(); ++i) {
        const bool color = !std::equal(&a.rgba[4 * i], &a.rgba[4 * i] + 4, &b.rgba[4 * i]);
        // Where triangles coincide, raw pictures may show different triangles: there, only colors are compared.
        if (color || (bit == 1 && a.triangles[i] != b.triangles[i]))
            marks[i] = static_cast<std::uint8_t>(marks[i] | bit);
    }
}

/// Copies one view to the sheet of all views in pale gray, with a colored square around each pixel that differs.
void paste(Picture& sheet, const Picture& view, const Marks& marks, std::uint32_t number) {
    const std::uint32_t left = number % kColumns * view.width, top = number / kColumns * view.height;
    const auto at = [&](std::uint32_t x, std::uint32_t y) {
        return &sheet.rgba[4 * (std::size_t{top + y} * sheet.width + left + x)];
    };
    for (std::uint32_t y = 0; y < view.height; ++y) {
        for (std::uint32_t x = 0; x < view.width; ++x) {
            const std::uint8_t* p = &view.rgba[4 * (std::size_t{y} * view.width + x)];
            const std::uint32_t gray = (54U * p[0] + 183U * p[1] + 19U * p[2]) / 256;
            const auto pale = static_cast<std::uint8_t>(p[3] == 0 ? 255 : 110 + gray / 2);
            std::fill_n(at(x, y), 3, pale);
            at(x, y)[3] = 255;
        }
    }
    constexpr std::array<std::array<std::uint8_t, 3>, 2> kColors{{{245, 160, 0}, {220, 0, 0}}};
    for (const std::uint8_t bit : {std::uint8_t{2}, std::uint8_t{1}}) {
        for (std::uint32_t y = 0; y < view.height; ++y) {
            for (std::uint32_t x = 0; x < view.width; ++x) {
                if ((marks[std::size_t{y} * view.width + x] & bit) == 0) continue;
                for (std::uint32_t j = y < 2 ? 0 : y - 2; j <= std::min(y + 2, view.height - 1); ++j) {
                    for (std::uint32_t i = x < 2 ? 0 : x - 2; i <= std::min(x + 2, view.width - 1); ++i) {
                        std::copy_n(kColors[bit == 1 ? 1 : 0].data(), 3, at(i, j));
                    }
                }
            }
        }
    }
}

void note_seen(std::vector<bool>& seen, const Picture& picture) {
    for (const std::uint32_t value : picture.triangles) {
        const std::uint32_t id = value & ~LR_FRONT_FLAG;
        if (id != 0 && id <= seen.size()) seen[id - 1] = true;
    }
}

Result<bool> indices_equal_cpu(Renderer& renderer, Drawable& drawable, const Model& model, const StreamViews& views) {
    LR_ASSIGN(const std::vector<std::uint32_t> device, renderer.read_indices(drawable));
    std::vector<std::uint32_t> host(device.size());
    const bool packed = is_packed(drawable.mesh.source);
    if (packed) {
        decode_packed(views.packed, host);
    } else {
        decode_lean(views.lean, host);
    }
    if (device != host) return false;
    if (!drawable.mesh.copies) return true;
    LR_ASSIGN(const std::vector<std::uint32_t> copies, renderer.read_copies(drawable));
    LR_ASSIGN(const StreamView stream, view_stream(packed ? model.packed.words : model.lean.words));
    decode_seams(views.seams, slot_triangles(stream), host);
    std::ranges::replace(host, UINT32_MAX, 0U);  // slots without a triangle
    return copies == host;
}

Result<bool> vertices_equal_cpu(Renderer& renderer, Drawable& drawable, const Model& model, const VertexView& view) {
    LR_ASSIGN(const std::vector<std::uint32_t> device, renderer.read_positions(drawable));
    std::vector<std::uint32_t> host(std::size_t{3} * view.vertices);
    decode_vertices(view, std::as_writable_bytes(std::span(host)));
    if (!drawable.mesh.positions) return device == host;
    std::vector<std::uint32_t> place(view.vertices);
    for (std::uint32_t v = 0; v < view.vertices; ++v) place[model.packed.vertex_order[v]] = v;
    for (std::size_t k = 0; k < device.size(); ++k) {
        const std::size_t v = place[model.surface_of(model.packed_seams.copy_order[k / 3])];
        if (device[k] != host[3 * v + k % 3]) return false;
    }
    return true;
}

/// Pictures of the mesh's own index list, from all sides.
struct Reference {
    std::array<Camera, kViews> cameras;
    std::array<Picture, kViews> raw, exact;
    std::uint64_t covered = 0, distinct_ids = 0;
};

/// Counts pictures and reports progress.
class Counter {
  public:
    Counter(const CompareProgress& progress, std::size_t subjects)
        : progress_(progress), total_(2 * kViews * static_cast<std::uint32_t>(1 + subjects)) {}
    void count() {
        if (progress_) progress_(++done_, total_);
    }

  private:
    const CompareProgress& progress_;
    std::uint32_t done_ = 0, total_;
};

Result<Reference> draw_reference(Renderer& renderer, const Model& model, Counter& counter) {
    Reference out;
    const auto [width, height] = renderer.target().extent();
    LR_ASSIGN(Drawable plain, renderer.upload(model, Source::plain));
    for (std::uint32_t v = 0; v < kViews; ++v) {
        CameraOptions camera;
        camera.direction = kDirections[v];
        LR_ASSIGN(out.cameras[v], make_camera(model, camera, width, height));
    }
    for (const bool exact : {false, true}) {
        for (std::uint32_t v = 0; v < kViews; ++v) {
            LR_ASSIGN((exact ? out.exact : out.raw)[v], renderer.draw(plain, model, out.cameras[v], exact));
            counter.count();
        }
    }
    std::vector<bool> seen(model.triangle_count());
    for (const Picture& picture : out.exact) {
        note_seen(seen, picture);
        for (const std::uint32_t id : picture.triangles) out.covered += id != 0 ? 1 : 0;
    }
    out.distinct_ids = static_cast<std::uint64_t>(std::count(seen.begin(), seen.end(), true));
    return out;
}

Result<Comparison> compare_one(Renderer& renderer, const Model& model, const Reference& reference,
                               const Subject& subject, Counter& counter) {
    const auto [width, height] = renderer.target().extent();
    LR_ASSIGN(Drawable stream, renderer.upload(model, subject.source, subject.path));
    Comparison out;
    out.views = kViews;
    out.covered_pixels = reference.covered;
    out.distinct_ids = reference.distinct_ids;
    const bool same_rasterizing = subject.path == Path::compute || subject.path == Path::pull;
    out.tolerated = same_rasterizing ? 0 : reference.covered / 10000;
    std::array<Marks, kViews> marks;
    for (std::uint32_t v = 0; v < kViews; ++v) {
        // The first draw also decodes the stream, in the same submission.
        LR_ASSIGN(const Picture picture, renderer.draw(stream, model, reference.cameras[v], false));
        const Difference d = difference(reference.raw[v], picture);
        out.raw_pixels_different += d.pixels;
        out.raw_pixels_beyond_one += d.beyond_one;
        out.raw_max_channel_difference = std::max(out.raw_max_channel_difference, d.channel);
        marks[v].assign(picture.pixels(), 0);
        mark(marks[v], reference.raw[v], picture, 2);
        counter.count();
    }
    LR_ASSIGN(const StreamViews views, view_streams(model, subject.source));
    LR_ASSIGN(out.indices_equal_cpu, indices_equal_cpu(renderer, stream, model, views));
    if (subject.source == Source::packed_vertices) {
        LR_ASSIGN(out.vertices_equal_cpu, vertices_equal_cpu(renderer, stream, model, views.vertices));
    }

    out.picture.width = kColumns * width;
    out.picture.height = kViews / kColumns * height;
    out.picture.rgba.resize(4 * out.picture.pixels());
    for (std::uint32_t v = 0; v < kViews; ++v) {
        LR_ASSIGN(const Picture picture, renderer.draw(stream, model, reference.cameras[v], true));
        const Difference d = difference(reference.exact[v], picture);
        out.pixels_different += d.pixels;
        out.max_channel_difference = std::max(out.max_channel_difference, d.channel);
        out.triangle_ids_different += d.triangles;
        mark(marks[v], reference.exact[v], picture, 1);
        paste(out.picture, reference.exact[v], marks[v], v);
        counter.count();
    }
    // Low thresholds, since a mesh may hide most of its triangles and a needle covers few pixels. The cameras fit the
    // mesh to the picture, so even a needle covers more than a thousandth of the pixels.
    const std::uint64_t pixels = std::uint64_t{width} * height * kViews;
    const std::uint64_t visible = std::min<std::uint64_t>(model.triangle_count(), out.covered_pixels);
    out.blank = out.covered_pixels * 1000 < pixels || out.distinct_ids < std::max<std::uint64_t>(1, visible / 1000);
    return out;
}

}  // namespace

Result<std::vector<Comparison>> compare(Context& context, const Model& model, std::span<const Subject> subjects,
                                        const CompareOptions& options) {
    RendererOptions renderer_options;
    renderer_options.view = options.view;
    renderer_options.width = options.width;
    renderer_options.height = options.height;
    renderer_options.max_range = options.max_range;
    LR_ASSIGN(Renderer renderer, Renderer::create(context, renderer_options));
    return compare(renderer, model, subjects, options.progress);
}

Result<std::vector<Comparison>> compare(Renderer& renderer, const Model& model, std::span<const Subject> subjects,
                                        const CompareProgress& progress) {
    Counter counter(progress, subjects.size());
    LR_ASSIGN(const Reference reference, draw_reference(renderer, model, counter));
    std::vector<Comparison> out;
    for (const Subject& subject : subjects) {
        LR_ASSIGN(Comparison comparison, compare_one(renderer, model, reference, subject, counter));
        out.push_back(std::move(comparison));
    }
    return out;
}

}  // namespace lacedring::gpu
