#pragma once
// The triangles of a mesh, drawn by one path.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "renderer/draw/view.h"
#include "renderer/mesh/gpu_mesh.h"
#include "renderer/vk/pipeline.h"

namespace lacedring::gpu {

/// One descriptor set for each draw command of a mesh.
struct DrawPlan {
    std::vector<VkDescriptorSet> sets;
};

class Surface {
  public:
    enum Pass : std::uint32_t {
        depth,    ///< writes depth alone
        claim,    ///< of the triangles at that depth, the one with the smallest original number claims the pixel
        resolve,  ///< shades the triangle that claimed the pixel
        single,   ///< one pass instead of these three: at equal depth, the first drawn triangle wins
    };
    static constexpr std::size_t kPasses = 4;

    /// `layout` has DrawConstants as push constants for surface_stages(). `seams`: for meshes with pulls_copies().
    /// `outlined`: Silhouettes will be drawn over the surface.
    static Result<Surface> create(Context& context, const Layout& layout, View view, Source source, Path path,
                                  bool seams, bool outlined);

    /// Draws every triangle of a mesh with the source, path and `seams` of create(). Writes to its buffers must be
    /// visible.
    void draw(VkCommandBuffer commands, Pass pass, const GpuMesh& mesh, const DrawPlan& plan) const;

  private:
    Context* context_ = nullptr;
    VkPipelineLayout layout_ = VK_NULL_HANDLE;
    std::array<PipelineHandle, kPasses> pipelines_;
};

/// The stages that see DrawConstants: vertex, geometry, mesh (if the device has it) and fragment.
VkShaderStageFlags surface_stages(const Context& context);

/// A pipeline for lines over a surface that is already drawn: blended, with a depth test but no depth writes.
GraphicsInfo line_pipeline(const char* name, const Shader& vertex, const Shader& fragment);

/// The push constants of a draw of slots [first, first + slots).
DrawConstants draw_constants(const GpuMesh& mesh, std::uint32_t first, std::uint32_t slots);

}  // namespace lacedring::gpu
