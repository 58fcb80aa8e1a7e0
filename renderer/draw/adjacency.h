#pragma once
// LR tables on the device and two uses of them: vertex normals and silhouettes. Neither needs an index buffer or edge
// list: shaders find neighbors by shaders/include/lacedring_operators.glsl. Paper: LR 2011, sections 4 and 5.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "lacedring/lacedring.hpp"
#include "renderer/draw/camera.h"
#include "renderer/draw/target.h"
#include "renderer/vk/commands.h"
#include "renderer/vk/pipeline.h"
#include "renderer/vk/transfer.h"

namespace lacedring::gpu {

struct AdjacencyOptions {
    RingOptions ring{};
    bool wart_skipping = true;
};

/// LR tables and positions of a mesh on the device: about 4 bytes per reference and 12 per vertex.
struct Adjacency {
    std::uint32_t vertices = 0;               ///< of the tables, copies of non-manifold vertices included
    std::uint32_t triangle_numbers = 0;       ///< LrView::triangle_numbers
    std::vector<std::uint32_t> vertex_order;  ///< by LR vertex: the mesh's vertex (at a seam, the first of several)
    Buffer tables;                            ///< the words of the whole LR stream
    Buffer positions;                         ///< 3 floats per vertex, in the tables' order
};

/// Builds the LR tables of the model's surface (corner table, ring, LR tables) and uploads them with the model's
/// positions. Cost: O(V + T). Errors: those of build_corner_table, of encode_lr and of Vulkan.
Result<Adjacency> upload_adjacency(Context& context, Transfer& transfer, const Model& model,
                                   const AdjacencyOptions& options = {});
/// Uploads existing tables, which must be valid (as encode_lr makes them). `positions`: 3 floats per vertex of the mesh
/// that the tables were made from. Errors: malformed (the header), and those of Vulkan.
Result<Adjacency> upload_adjacency(Context& context, Transfer& transfer, const EncodedLr& tables,
                                   std::span<const float> positions);

/// Computes smooth normals from positions and LR tables alone.
class VertexNormals {
  public:
    static Result<VertexNormals> create(Context& context);

    /// Returns unit normals, 3 floats per vertex in the tables' order, visible to later submissions: the area-weighted
    /// sums of vertex_normals (topology.hpp), normalized; (0,0,1) where the sum is zero. The shader computes with pairs
    /// of floats; relative error: about 2^-44 * (sum of the cross products' lengths) / (length of their sum).
    /// Waits for the device. Cost: O(T).
    Result<Buffer> compute(Commands& commands, const Adjacency& adjacency) const;

  private:
    Context* context_ = nullptr;
    Layout layout_;
    PipelineHandle pipeline_;
};

struct SilhouetteStyle {
    double crease = 40;  ///< degrees: edges where the surface bends by more are drawn; 180 or more: none
    std::array<float, 4> color{0.03F, 0.03F, 0.03F, 1};
    float width = 1.5F;  ///< in supersampled pixels
};

/// Draws over a surface: borders, creases, and edges between a triangle that faces the eye and one that does not.
/// The vertex shader decides per corner, by the LR tables; there is no edge list and no work per edge on the host.
class Silhouettes {
  public:
    /// `lines_per_draw`: meshes with more lines take several draws. Tests make it small.
    static Result<Silhouettes> create(Context& context, std::uint32_t lines_per_draw = 1U << 29);

    /// Sets camera and style of the next frames drawn to `target`. Must not be called while a frame is being drawn.
    void set_frame(const Camera& camera, const Target& target, const SilhouetteStyle& style);

    /// Records a separate rendering instance. `target` must already hold the surface's color and depth, pushed back
    /// (GraphicsInfo::push_back): otherwise triangles seen edge-on hide their own outline.
    void record(VkCommandBuffer commands, const Adjacency& adjacency, const Target& target) const;

  private:
    Context* context_ = nullptr;
    std::uint32_t lines_per_draw_ = 0;
    float line_width_ = 1;
    float crease_cos_ = 0;
    Layout layout_;
    PipelineHandle pipeline_;
    Buffer frame_;
    Descriptors descriptors_;
    VkDescriptorSet set_ = VK_NULL_HANDLE;
};

/// The camera's position in world space.
std::array<float, 3> eye_of(const Camera& camera);

}  // namespace lacedring::gpu
