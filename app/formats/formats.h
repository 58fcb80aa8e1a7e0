#pragma once
// Makes and measures one mesh in every format: for stats, verify, bench, report and the viewer.

#include <algorithm>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "app/cli/command.h"
#include "lacedring/lacedring.hpp"
#include "lacedring/streams.hpp"
#include "lacedring/surface.hpp"
#include "lacedring/topology.hpp"
#include "lrlab/rivals/strips.h"

namespace lacedring::app {

/// One mesh in one format.
struct MeasuredFormat {
    std::string name;
    std::size_t bytes = 0;
    std::size_t references = 0;  ///< 0: the format has none
    /// The decoded triangles in the format's order, with the format's vertex numbers.
    std::vector<std::uint32_t> indices = {};
    /// order[vertex number of the format] = vertex of the surface; empty: the numbers are the same.
    std::vector<std::uint32_t> order = {};
    const char* ring = nullptr;  ///< "expander", "hybrid" or "optimized"; null: no ring
    std::uint32_t k = 0;         ///< RingOptions::k
    std::uint32_t passes = 0;    ///< of the optimizer
    /// Copies of non-manifold vertices, which `order` has in addition.
    std::size_t copies = 0;
    std::size_t seam_bytes = 0;  ///< of the seam section; not part of `bytes`
    std::size_t deflated = 0;    ///< bytes after zlib; 0: not deflated
    /// Why the format's own validation failed; empty: valid.
    std::string invalid = {};

    /// Number of vertices of the format; `vertices` is FormatSet::vertices.
    std::size_t vertex_count(std::uint32_t vertices) const { return vertices + copies; }
};

struct FormatSet {
    std::uint32_t vertices = 0;    ///< of the surface
    std::uint32_t seam_edges = 0;  ///< of the surface
    TopologyReport report;
    Topology topology;
    LeanStatistics lean;
    LrStatistics lr;
    LrStatistics lr_compact;
    std::uint32_t lr_compact_long = 0;  ///< n_l of section 8
    PackedStatistics packed;
    std::optional<CacheFigures> best_order;  ///< of meshoptimizer's vertex-cache order
    RingOptions ring;                        ///< of lean
    std::vector<MeasuredFormat> formats;
    std::vector<std::pair<std::string, std::string>> absent;  ///< name, reason

    /// Divisor of bits and references per triangle: triangles without degenerate ones, at least 1.
    double triangles() const { return std::max(1.0, static_cast<double>(report.triangles)); }
};

/// The index list without degenerate triangles.
std::vector<std::uint32_t> without_degenerate(std::span<const std::uint32_t> indices);

/// Called before each format `what` is made, when `share` of the work is done. Return false to stop: the result then
/// has only the formats made so far.
using FormatProgress = std::function<bool(double share, const std::string& what)>;

/// Encodes the surface in every format and decodes it again; our formats also get a seam section if the mesh has seams.
/// `paper`: only the paper's procedures, without the optimizer. `progress`, if given, replaces the progress bar on the
/// terminal. `quick`: only index lists, strips, lean, lr and packed, for scenes with many primitives. Errors: those of
/// build_corner_table and of encode for packed.
Result<FormatSet> make_formats(const Mesh& mesh, const Surface& surface, const RingChoice& choice, bool paper = false,
                               const FormatProgress& progress = {}, bool quick = false);

struct FormatCheck {
    std::string name;
    /// The fault of the format; empty if it decodes to the same oriented triangles and vertices.
    std::string why;
};

/// Compares every format of the set with the mesh that the set was made of.
std::vector<FormatCheck> check_formats(const FormatSet& set, const Mesh& mesh, const Surface& surface);

}  // namespace lacedring::app
