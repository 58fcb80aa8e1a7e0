#pragma once
// The corner operators in shaders: LR tables on the device, and two uses of them. Neither has an index buffer or a list
// of edges: shaders/include/lacedring_operators.glsl says what lies beside what. Paper: LR 2011, sections 4 and 5.

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

/// LR tables and positions of a mesh on the device, some 4 bytes a reference and 12 a vertex.
struct Adjacency {
    std::uint32_t vertices = 0;               ///< with the copies of non-manifold ones
    std::uint32_t triangle_numbers = 0;       ///< as LrView::triangle_numbers
    std::vector<std::uint32_t> vertex_order;  ///< the mesh's vertex of each one; of several at a seam, the first
    Buffer tables;                            ///< the whole stream, words
    Buffer positions;                         ///< 3 floats a vertex, in the tables' order
};

/// Makes the tables of the model's surface (corner table, ring, LR tables), in its unit sphere. Cost: O(V + T).
/// Errors: build_corner_table's, encode_lr's and Vulkan's.
Result<Adjacency> upload_adjacency(Context& context, Transfer& transfer, const Model& model,
                                   const AdjacencyOptions& options = {});
/// Of tables that are there already, and must be valid (as encode_lr makes them). `positions`: 3 floats a vertex of the
/// mesh that they were made from. Errors: malformed (the header), and Vulkan's.
Result<Adjacency> upload_adjacency(Context& context, Transfer& transfer, const EncodedLr& tables,
                                   std::span<const float> positions);

/// Smooth normals from positions and tables alone.
class VertexNormals {
  public:
    static Result<VertexNormals> create(Context& context);

    /// Unit normals, 3 floats a vertex in the tables' order, visible to whatever is submitted next: the area-weighted
    /// sums of vertex_normals (topology.hpp), (0,0,1) where there is none. Two floats a number:
    /// an error of about 2^-44 times the sum of the lengths of all products by the length of the result.
    /// Waits for the device. Cost: O(T).
    Result<Buffer> compute(Commands& commands, const Adjacency& adjacency) const;

  private:
    Context* context_ = nullptr;
    Layout layout_;
    PipelineHandle pipeline_;
};

struct SilhouetteStyle {
    double crease = 40;  ///< degrees: edges at which the surface turns by more are drawn. From 180 on, none
    std::array<float, 4> colour{0.03F, 0.03F, 0.03F, 1};
    float width = 1.5F;  ///< pixels, those of supersampling included
};

/// Draws borders, edges between a triangle that faces the eye and one that does not, and creases, over a surface.
/// The vertex shader asks the tables at every corner; there is no list of edges, and the host does nothing an edge.
class Silhouettes {
  public:
    /// `lines_per_draw`: longer meshes take several draws; a test makes it small.
    static Result<Silhouettes> create(Context& context, std::uint32_t lines_per_draw = 1U << 29);

    /// What the next pictures of that target are taken with. Not while one is being drawn.
    void set_frame(const Camera& camera, const Target& target, const SilhouetteStyle& style);

    /// Records a rendering instance of its own, after the surface's: colours and depth of `target` must hold it, pushed
    /// back (GraphicsInfo::push_back), or triangles seen from the side cover their own outline.
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

/// Where the camera is, in the world.
std::array<float, 3> eye_of(const Camera& camera);

}  // namespace lacedring::gpu
