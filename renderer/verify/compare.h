#pragma once
// Compares pictures drawn from a stream with pictures drawn from the mesh's own index list.

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "lacedring/base.hpp"
#include "renderer/draw/picture.h"
#include "renderer/draw/renderer.h"
#include "renderer/mesh/gpu_mesh.h"
#include "renderer/mesh/model.h"
#include "renderer/vk/context.h"

namespace lacedring::gpu {

/// The source and path to compare with the mesh's own index list.
struct Subject {
    Source source = Source::lean;
    Path path = Path::compute;
};

/// Called after each picture with the numbers of pictures drawn and to draw.
using CompareProgress = std::function<void(std::uint32_t done, std::uint32_t total)>;

struct CompareOptions {
    std::uint32_t width = 1280;
    std::uint32_t height = 720;
    View view = View::smooth;     ///< smooth, or material if the model has materials
    std::uint64_t max_range = 0;  ///< see UploadOptions
    CompareProgress progress = {};
};

/// Result of a comparison: sums over all views; members named max_... are maxima.
struct Comparison {
    std::uint32_t views = 0;
    std::uint64_t pixels_different = 0;
    std::uint32_t max_channel_difference = 0;  ///< 0 to 255
    std::uint64_t triangle_ids_different = 0;  ///< pixels that show another triangle, or its other side
    /// Device and CPU decode the same indices and copies (Renderer::read_indices, read_copies).
    bool indices_equal_cpu = false;
    /// Source::packed_vertices: device and CPU decode the same position bits (Renderer::read_positions).
    std::optional<bool> vertices_equal_cpu;
    // raw_...: pictures of unrotated triangles, without tie-breaking.
    std::uint64_t raw_pixels_different = 0;
    std::uint32_t raw_max_channel_difference = 0;
    std::uint64_t raw_pixels_beyond_one = 0;  ///< by more than 1/255: another triangle was nearer, or drawn first
    std::uint64_t covered_pixels = 0;         ///< in the mesh's own pictures
    std::uint64_t distinct_ids = 0;           ///< different triangles seen in the mesh's own pictures
    /// Nearly nothing is visible (coinciding triangles, needles, hidden shells): the pictures say little about the
    /// stream. The decoded indices are compared nevertheless.
    bool blank = false;
    Picture picture;  ///< all views in pale gray; red: exact pictures differ; amber: only raw pictures differ

    /// Number of pixels that may differ by 1/255. 0 for Path::compute and Path::pull. Drivers clip and interpolate the
    /// output of geometry and mesh shaders in other batches and by other code.
    std::uint64_t tolerated = 0;

    /// True if no more than the tolerated pixels differ. Does not consider `blank`.
    bool same() const {
        return pixels_different <= tolerated && max_channel_difference <= (tolerated == 0 ? 0U : 1U) &&
               triangle_ids_different == 0 && indices_equal_cpu && vertices_equal_cpu.value_or(true);
    }
};

/// Draws the mesh from its index list and then from each subject, from six sides: first raw (index buffers as they
/// are), then exactly (docs/renderer.md). Draws the model's streams and maps unchecked, so a wrong stream shows as a
/// difference; its indices must be in range (validate_lean, validate_packed). Memory: twelve pictures.
Result<std::vector<Comparison>> compare(Context& context, const Model& model, std::span<const Subject> subjects,
                                        const CompareOptions& options);
/// Compares with an existing renderer, so that many models can use its pipelines.
Result<std::vector<Comparison>> compare(Renderer& renderer, const Model& model, std::span<const Subject> subjects,
                                        const CompareProgress& progress = {});
inline Result<Comparison> compare(Context& context, const Model& model, const Subject& subject,
                                  const CompareOptions& options) {
    Result<std::vector<Comparison>> all = compare(context, model, std::span(&subject, 1), options);
    if (!all) return all.error();
    return std::move(all->front());
}

}  // namespace lacedring::gpu
