#pragma once
// The triangle primitives of a glTF's meshes, checked before values are read. Internal to lrio.

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "lacedring/base.hpp"
#include "lrio/gltf/gltf_accessor.h"
#include "lrio/gltf/gltf_file.h"
#include "lrio/gltf/gltf_scene.h"
#include "lrio/mesh/read_formats.h"

namespace lacedring::detail {

using NamedViews = std::map<std::string, AccessorView>;

/// The vertices of successive primitives of a mesh that have the same accessors.
struct VertexBlock {
    const std::map<std::string, int>* accessors = nullptr;
    NamedViews views;
    std::size_t count = 0;
    std::size_t primitives = 0;  ///< number of primitives that use it
};

struct PrimitivePlan {
    std::size_t block = 0;  ///< index into MeshPlan::blocks
    int mode = TINYGLTF_MODE_TRIANGLES;
    std::size_t number = 0;  ///< its index in the file's mesh
    std::optional<AccessorView> indices;

    std::size_t corner_count(std::size_t vertices) const {
        const std::size_t count = indices ? indices->count : vertices;
        if (mode == TINYGLTF_MODE_TRIANGLES) return count;
        return count < 3 ? 0 : (count - 2) * 3;
    }
};

struct MeshPlan {
    bool made = false;
    std::vector<VertexBlock> blocks;
    std::vector<PrimitivePlan> primitives;  ///< primitives with triangles
    double vertices = 0, corners = 0;       ///< totals of `blocks` and `primitives`
};

/// Plans the meshes that a scene places, and counts their contents that are not triangles.
class MeshPlans {
  public:
    MeshPlans(GltfFile& file, Reading& reading) : file_(file), reading_(reading) {}

    /// Errors: malformed, unsupported, those of view_accessor.
    Result<void> make(const std::vector<MeshInstance>& instances);

    /// A plan for each of the file's meshes; MeshPlan::made is false if no instance places the mesh.
    const std::vector<MeshPlan>& meshes() const { return meshes_; }
    std::size_t primitive_count() const;

    /// Names of attributes that a Mesh cannot hold.
    const std::set<std::string>& unreadable() const { return unreadable_; }

    /// Reports morph targets, points, lines and primitives without positions.
    void tell_what_is_left_out() const;

  private:
    Result<void> plan_primitive(MeshPlan& plan, const tinygltf::Primitive& from, std::size_t number);
    Result<std::size_t> find_block(MeshPlan& plan, const tinygltf::Primitive& from);

    GltfFile& file_;
    Reading& reading_;
    std::vector<MeshPlan> meshes_;
    std::size_t points_ = 0, lines_ = 0, without_position_ = 0, morph_targets_ = 0;
    std::set<std::string> unreadable_;
};

/// Appends the primitive's triangles to `indices`. `first_vertex` is the index of the block's first vertex, `vertices`
/// the block's number of vertices. Errors: malformed.
Result<void> append_triangles(const PrimitivePlan& primitive, std::uint32_t first_vertex, std::size_t vertices,
                              std::vector<std::uint32_t>& indices);

/// Reports the number of nodes if there are several, and of instances beyond the first of each mesh.
void tell_of_nodes(const GltfFile& file, const MeshPlans& plans, const std::vector<MeshInstance>& instances,
                   Reading& reading);

}  // namespace lacedring::detail
