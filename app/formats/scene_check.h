#pragma once
// Checks of scenes and of whole files, for verify and compare.

#include <cstddef>
#include <cstdint>
#include <string>

#include "app/cli/input.h"

namespace lacedring::app {

/// The first difference between the joined mesh and the placed primitives.
struct PlacedDifference {
    const LoadedPrimitive* primitive = nullptr;  ///< null: triangles of no primitive
    std::string why;                             ///< empty: no difference
};

/// Compares the joined mesh with every primitive as placed by every node, corner by corner: positions, and attributes
/// that both have in the same type. With a tolerance > 0, which moves vertices, compares only numbers of triangles.
/// Cost: O(joined mesh).
PlacedDifference check_placed(const LoadedScene& scene, double tolerance);

/// Number of triangles of all primitives; each primitive counts once.
std::size_t count_triangles(const LoadedScene& scene);

/// Makes a lossless .lr file of the mesh, reads it, and returns the first difference; empty: none. `threads`: 0 for all
/// of the machine. Cost: encode at effort 0, and compressing the attributes.
std::string check_file(const Mesh& mesh, const Surface& surface, std::uint32_t threads);

}  // namespace lacedring::app
