#pragma once
// Is the picture that a stream gives the picture that the mesh's own index list gives?

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

/// What the mesh's own index list is compared with.
struct Subject {
    Source source = Source::lean;
    Path path = Path::compute;
};

/// Told after each picture how many of how many are drawn.
using CompareProgress = std::function<void(std::uint32_t done, std::uint32_t total)>;

struct CompareOptions {
    std::uint32_t width = 1280;
    std::uint32_t height = 720;
    View view = View::smooth;     ///< or material, of a model that has any
    std::uint64_t max_range = 0;  ///< see UploadOptions
    CompareProgress progress = {};
};

/// Sums over all views, largest values where the name says so.
struct Comparison {
    std::uint32_t views = 0;
    std::uint64_t pixels_different = 0;
    std::uint32_t max_channel_difference = 0;  ///< of 255
    std::uint64_t triangle_ids_different = 0;  ///< pixels that show another triangle, or its other side
    /// The device decodes the same indices and copies as the CPU (Renderer::read_indices, read_copies).
    bool indices_equal_cpu = false;
    /// Source::packed_vertices: the positions that the device decodes (Renderer::read_positions), bit for bit
    std::optional<bool> vertices_equal_cpu;
    std::uint64_t raw_pixels_different = 0;  ///< without rotating triangles and without breaking ties
    std::uint32_t raw_max_channel_difference = 0;
    std::uint64_t raw_pixels_beyond_one = 0;  ///< of these, by more than 1/255: another triangle was nearer, or first
    std::uint64_t covered_pixels = 0;         ///< of the mesh's own picture
    std::uint64_t distinct_ids = 0;           ///< different triangles seen in the mesh's own pictures
    /// Nearly nothing is to be seen: of coinciding triangles, needles, hidden shells. The pictures then say little of
    /// the stream; what the device decodes was compared all the same.
    bool blank = false;
    Picture picture;  ///< all views, pale; red where they differ, amber where only the raw ones do

    /// Most pixels that may differ by 1/255. None, where vertices go to the rasterizer from a vertex shader; geometry
    /// and mesh shaders send them there in other batches, clipped and interpolated by other code.
    std::uint64_t tolerated = 0;

    /// Nothing differs. `blank` is another matter.
    bool same() const {
        return pixels_different <= tolerated && max_channel_difference <= (tolerated == 0 ? 0U : 1U) &&
               triangle_ids_different == 0 && indices_equal_cpu && vertices_equal_cpu.value_or(true);
    }
};

/// Draws the mesh plain and from streams of it, one after the other, from six sides: first as the
/// index buffers are, then exactly (docs/renderer.md). The stream and its maps are taken from the model as they are: a
/// wrong one is drawn and found out, as long as it is in range (validate_lean, validate_packed). Memory: twelve
/// pictures.
Result<std::vector<Comparison>> compare(Context& context, const Model& model, std::span<const Subject> subjects,
                                        const CompareOptions& options);
/// With a renderer that is there, whose pipelines serve many models.
Result<std::vector<Comparison>> compare(Renderer& renderer, const Model& model, std::span<const Subject> subjects,
                                        const CompareProgress& progress = {});
inline Result<Comparison> compare(Context& context, const Model& model, const Subject& subject,
                                  const CompareOptions& options) {
    Result<std::vector<Comparison>> all = compare(context, model, std::span(&subject, 1), options);
    if (!all) return all.error();
    return std::move(all->front());
}

}  // namespace lacedring::gpu
