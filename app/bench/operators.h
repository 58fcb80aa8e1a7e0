#pragma once
// Figure 10 of LR 2011, in memory: the same algorithms on every structure with corner operators.

#include <string>
#include <utility>
#include <vector>

#include "app/bench/measure.h"
#include "lacedring/base.hpp"
#include "lacedring/mesh.hpp"
#include "lacedring/topology.hpp"

namespace lacedring::app {

struct OperatorFigures {
    std::string structure;
    double references_per_triangle = 0;
    struct Row {
        std::string name;  ///< vertex, opposite, valence, normal, contour
        std::vector<double> seconds;
        std::size_t elements = 0;
        double ns_per_op() const;
    };
    std::vector<Row> rows;
};

struct OperatorBench {
    std::vector<OperatorFigures> structures;
    std::vector<std::pair<std::string, std::string>> absent;  ///< structure, reason
};

/// Returns why SQuad's operators cannot be timed on a pseudo-manifold table (its c.v is O(valence)); empty if they can.
std::string no_squad_operators(const CornerTable& table);

/// Times sequential loops over all corners (c.v; c.o, or c.s for SQuad) and vertices (valence, normal), and walks along
/// the contours of a plane through the mesh's middle (time per triangle). Structures take turns; each has vertex
/// positions in its own order. Errors: invalid_argument if two structures disagree on a result.
Result<OperatorBench> measure_operators(const Mesh& mesh, CornerTable table, int rounds);

}  // namespace lacedring::app
