#pragma once
// Everything that draws pictures of one model, put together.

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
    std::uint32_t width = 1280;  ///< of what is drawn, supersampling included
    std::uint32_t height = 720;
    std::uint32_t samples = 1;    ///< lines get this much wider
    double crease = 40;           ///< View::silhouette: see SilhouetteStyle
    std::uint64_t max_range = 0;  ///< see UploadOptions
};

class Renderer {
  public:
    static Result<Renderer> create(Context& context, const RendererOptions& options);

    /// Of View::material: the model's materials as well, in place of another model's, whose drawables are then of no
    /// use.
    Result<Drawable> upload(const Model& model, Source source, Path path = Path::compute);
    /// What is not drawn of the materials uploaded last, a line each.
    std::vector<std::string> notes() const { return materials_ ? materials_->notes : std::vector<std::string>(); }
    /// Bytes of device memory that this takes beside what the renderer has already (context().arena().used()); without
    /// what View::silhouette asks for neighbours, which is known once its tables are made.
    std::uint64_t device_bytes(const Model& model, Source source, Path path = Path::compute) const;

    /// Records the decoding of a stream and what makes it visible, if that has not been done.
    void decode(VkCommandBuffer commands, Drawable& drawable) const;
    /// Records the decoding of the vertex stream alone.
    void decode_vertices(VkCommandBuffer commands, const Drawable& drawable) const {
        expander_.decode_vertices(commands, drawable);
    }

    /// One picture. `exact`: triangles rotated to begin with their smallest vertex, and ties broken by number, so that
    /// all sources give the same bits; a drawable stays rotated after it. Otherwise as the index buffer is.
    Result<Picture> draw(Drawable& drawable, const Model& model, const Camera& camera, bool exact);

    /// 3 * slots indices as the device decodes them: of Path::compute what is in the index buffer, decoded first if
    /// need be; of the others what their shaders get, slot by slot.
    Result<std::vector<std::uint32_t>> read_indices(Drawable& drawable);

    /// Reads the copy of each of these corners in the same way; nothing where the surface has no seams.
    Result<std::vector<std::uint32_t>> read_copies(Drawable& drawable);

    /// Source::packed_vertices: the bits of 3 floats a vertex, in the mesh's coordinates, as the device decodes them.
    /// The positions in the vertex buffer (Path::compute), of copies where there are seams; or those that the shaders
    /// of other paths decode, vertex by vertex of the stream.
    Result<std::vector<std::uint32_t>> read_positions(Drawable& drawable);

    /// Words of its stream that decoding every slot by itself loads: what a picture by Path::geometry or mesh reads,
    /// and a third of what one by Path::pull does.
    Result<WordsRead> words_read(const Drawable& drawable);

    Context& context() { return *context_; }
    Commands& commands() { return *commands_; }
    Transfer& transfer() { return *transfer_; }
    const Target& target() const { return target_; }
    Painter& painter() { return painter_; }

  private:
    Renderer() = default;
    Result<std::vector<std::uint32_t>> read_decoded(Drawable& drawable, const Buffer& indices);
    /// Normals of the mesh's vertices, by the device, from positions and tables of the surface alone. Of a vertex in
    /// several fans: that of the first.
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
    std::pair<std::uint64_t, std::uint32_t> uploaded_materials_{};  // a model's number, and its triangles
    std::optional<Silhouettes> silhouettes_;                        // these two for View::silhouette
    std::optional<VertexNormals> vertex_normals_;
};

}  // namespace lacedring::gpu
