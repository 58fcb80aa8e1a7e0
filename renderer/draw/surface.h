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

/// A mesh ready to be drawn: one descriptor set a draw command.
struct DrawPlan {
    std::vector<VkDescriptorSet> sets;
};

class Surface {
  public:
    enum Pass : std::uint32_t {
        depth,    ///< depth alone
        claim,    ///< at equal depth: the smallest original triangle claims the pixel
        resolve,  ///< at equal depth: the triangle that claimed it is shaded
        single,   ///< all at once, the first drawn wins
    };
    static constexpr std::size_t kPasses = 4;

    /// The layout has DrawConstants for surface_stages(). `seams`: of meshes that have pulls_copies(). `outlined`:
    /// lines of others are drawn over it.
    static Result<Surface> create(Context& context, const Layout& layout, View view, Source source, Path path,
                                  bool seams, bool outlined);

    /// Draws every triangle of a mesh that has this source and path, and seams. Its buffers must be visible.
    void draw(VkCommandBuffer commands, Pass pass, const GpuMesh& mesh, const DrawPlan& plan) const;

  private:
    Context* context_ = nullptr;
    VkPipelineLayout layout_ = VK_NULL_HANDLE;
    std::array<PipelineHandle, kPasses> pipelines_;
};

/// The stages that make vertices, and the fragment stage: all see DrawConstants.
VkShaderStageFlags surface_stages(const Context& context);

/// A pipeline of lines over a surface that is drawn already: blended, not nearer than it in the depth buffer.
GraphicsInfo line_pipeline(const char* name, const Shader& vertex, const Shader& fragment);

/// What shaders need to know of slots [first, first + slots).
DrawConstants draw_constants(const GpuMesh& mesh, std::uint32_t first, std::uint32_t slots);

}  // namespace lacedring::gpu
