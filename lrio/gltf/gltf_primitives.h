#pragma once
// The triangle primitives of a glTF's meshes, checked before any value is read. Internal to lrio.

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

/// Vertices that one or more primitives of a mesh use: those with the same accessors share them, as in the file.
struct VertexBlock {
    const std::map<std::string, int>* accessors = nullptr;
    NamedViews views;
    std::size_t count = 0;
    std::size_t primitives = 0;  ///< that use it
};

struct PrimitivePlan {
    std::size_t block = 0;
    int mode = TINYGLTF_MODE_TRIANGLES;
    std::size_t number = 0;  ///< in its mesh
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
    std::vector<PrimitivePlan> primitives;  ///< those with triangles
    double vertices = 0, corners = 0;       ///< of all of them
};

/// The meshes that a scene places, and what of them is no triangle.
class MeshPlans {
  public:
    MeshPlans(GltfFile& file, Reading& reading) : file_(file), reading_(reading) {}

    /// Errors: malformed, unsupported, view_accessor's.
    Result<void> make(const std::vector<MeshInstance>& instances);

    /// One for each of the file's meshes; those that no instance places are not made.
    const std::vector<MeshPlan>& meshes() const { return meshes_; }
    std::size_t primitive_count() const;

    /// Names of attributes that no Mesh can hold.
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

/// Appends the primitive's triangles, the block's first vertex being `first_vertex`. Errors: malformed.
Result<void> append_triangles(const PrimitivePlan& primitive, std::uint32_t first_vertex, std::size_t vertices,
                              std::vector<std::uint32_t>& indices);

/// Reports the nodes, where there are several, and the placements beyond each mesh's first one.
void tell_of_nodes(const GltfFile& file, const MeshPlans& plans, const std::vector<MeshInstance>& instances,
                   Reading& reading);

}  // namespace lacedring::detail
