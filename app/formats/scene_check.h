#pragma once
// Checks of scenes and of whole files, for verify and compare.

#include <cstddef>
#include <cstdint>
#include <string>

#include "app/cli/input.h"

namespace lacedring::app {

/// The first difference between the joined mesh and the placed primitives.
struct PlacedDifference {
    const LoadedPrimitive* primitive = nullptr;  ///< null: triangles that are of none
    std::string why;                             ///< empty: there is none
};

/// Compares the joined mesh with every primitive through every node's transform, corner by corner: positions, and the
/// attributes that both have alike. With a tolerance, which moves vertices, numbers of triangles alone.
/// Cost: O(joined mesh).
PlacedDifference check_placed(const LoadedScene& scene, double tolerance);

/// Triangles of all primitives, each counted once.
std::size_t count_triangles(const LoadedScene& scene);

/// Makes a lossless .lr file of the mesh and reads it: empty, or what it does not give back. Cost: encode's at effort
/// 0, and the attributes' streams. `threads`: as asked for.
std::string check_file(const Mesh& mesh, const Surface& surface, std::uint32_t threads);

}  // namespace lacedring::app
