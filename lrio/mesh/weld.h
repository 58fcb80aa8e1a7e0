#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "lrio/mesh/mesh.h"

namespace lr {

enum class Weld {
    none,
    attributes,  ///< vertices that are the same in all attributes become one
    position,    ///< vertices at the same POSITION become one; the first one's attributes are kept
};

/// Attribute values that Weld::position drops: those that differ from the kept vertex's.
struct WeldReport {
    std::uint32_t vertices = 0;           ///< that lose some attribute's value
    std::vector<std::string> attributes;  ///< of which values are lost
};

/// Merges vertices whose values have identical bits; of POSITION, -0 is 0. The first of each group is kept as it is, in
/// the order of first appearance. Triangles keep their order; some may become degenerate. Unused vertices take part.
/// Cost: O(V) expected time, O(V log V) at most; about 4 bytes a vertex and 10 to 17 a group beside the result.
/// `report` may be null.
Mesh weld(const Mesh& mesh, Weld mode, WeldReport* report = nullptr);

}  // namespace lr
