#pragma once
// Uploads models and draws pictures of them: owns the passes, target and command buffer that this takes.

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "renderer/draw/adjacency.h"
#include "renderer/draw/drawable.h"
#include "renderer/draw/painter.h"
#include "renderer/draw/slot_reader.h"
#include "renderer/mesh/gpu_materials.h"
#include "renderer/vk/context.h"

namespace lacedring::gpu {

struct RendererOptions {
    View view = View::smooth;
    std::uint32_t width = 1280;  ///< width and height in supersampled pixels
    std::uint32_t height = 720;
    std::uint32_t samples = 1;    ///< per pixel along each side; lines get wider by this factor
    double crease = 40;           ///< View::silhouette: see SilhouetteStyle
    std::uint64_t max_range = 0;  ///< see UploadOptions
};

class Renderer {
  public:
    static Result<Renderer> create(Context& context, const RendererOptions& options);

    /// With View::material, also uploads the model's materials and frees those of the model before: its drawables can
    /// no longer be drawn.
    Result<Drawable> upload(const Model& model, Source source, Path path = Path::compute);
    /// Images of the materials uploaded last that are not drawn, a line each with the reason.
    std::vector<std::string> notes() const { return materials_ ? materials_->notes : std::vector<std::string>(); }
    /// Device memory in bytes that upload() adds to what is allocated already (context().arena().used()). Excludes the
    /// LR tables of View::silhouette, whose size is known only once they are built.
    std::uint64_t device_bytes(const Model& model, Source source, Path path = Path::compute) const;

    /// Records the decoding of the drawable's streams, unless already recorded, and a barrier that makes it visible.
    void decode(VkCommandBuffer commands, Drawable& drawable) const;
    /// Records the decoding of the vertex stream alone.
    void decode_vertices(VkCommandBuffer commands, const Drawable& drawable) const {
        expander_.decode_vertices(commands, drawable);
    }

    /// Draws one picture. `exact`: rotates triangles to begin with their smallest vertex and breaks depth ties by
    /// number, so that all sources give the same bits; the drawable stays rotated. Otherwise draws the index buffer as
    /// it is; invalid_argument if the drawable is rotated.
    Result<Picture> draw(Drawable& drawable, const Model& model, const Camera& camera, bool exact);

    /// Returns 3 * slots indices as the device decodes them. Path::compute: reads the index buffer, after decoding if
    /// necessary. Other paths: runs their shaders' decoder for every slot.
    Result<std::vector<std::uint32_t>> read_indices(Drawable& drawable);

    /// Returns the vertex copies at the same 3 * slots corners; empty if the surface has no seams.
    Result<std::vector<std::uint32_t>> read_copies(Drawable& drawable);

    /// Source::packed_vertices: returns the bits of 3 floats per vertex, in the mesh's coordinates, as the device
    /// decodes them. Path::compute: reads the vertex buffer (one entry per copy if there are seams). Other paths: runs
    /// their shaders' decoder for every vertex of the stream.
    Result<std::vector<std::uint32_t>> read_positions(Drawable& drawable);

    /// Counts the stream words that are loaded when each slot is decoded on its own (Path::geometry: four at a time).
    /// Path::geometry and Path::mesh read as many words per picture, Path::pull three times as many.
    Result<WordsRead> words_read(const Drawable& drawable);

    Context& context() { return *context_; }
    Commands& commands() { return *commands_; }
    Transfer& transfer() { return *transfer_; }
    const Target& target() const { return target_; }
    Painter& painter() { return painter_; }

  private:
    Renderer() = default;
    Result<std::vector<std::uint32_t>> read_decoded(Drawable& drawable, const Buffer& indices);
    /// Computes the normals of the mesh's vertices on the device, from positions and LR tables of the surface alone. A
    /// vertex with several fans of triangles gets the normal of the first.
    Result<std::vector<float>> normals_of(const Adjacency& adjacency, const Model& model);

    Context* context_ = nullptr;
    RendererOptions options_;
    std::optional<Commands> commands_;
    std::optional<Transfer> transfer_;
    Target target_;
    Painter painter_;
    Expander expander_;
    SlotReader slots_;
    std::optional<GpuMaterials> materials_;                         // View::material
    std::pair<std::uint64_t, std::uint32_t> uploaded_materials_{};  // Model::materials_number, triangle count
    std::optional<Silhouettes> silhouettes_;                        // View::silhouette
    std::optional<VertexNormals> vertex_normals_;                   // View::silhouette
};

}  // namespace lacedring::gpu
