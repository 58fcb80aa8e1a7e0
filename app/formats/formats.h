#pragma once
// Every format that one mesh can be stored in, made and measured. Shared by stats and verify.

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

/// One format of one mesh. `indices` are the triangles as the format gives them back, in its order.
struct MeasuredFormat {
    std::string name;
    std::size_t bytes = 0;
    std::size_t references = 0;               ///< 0 where it has none
    std::vector<std::uint32_t> indices = {};  ///< numbered as `order` says
    /// order[new] = vertex of the surface; empty if the format keeps its numbers
    std::vector<std::uint32_t> order = {};
    const char* ring = nullptr;  ///< "expander", "hybrid" or "optimized"; null for a format without one
    std::uint32_t k = 0;         ///< of the hybrid
    std::uint32_t passes = 0;    ///< of the optimizer
    std::size_t copies = 0;      ///< of non-manifold vertices: entries of `order` beyond the mesh's vertices
    std::size_t seam_bytes = 0;  ///< of the seam section, beside `bytes`
    std::size_t deflated = 0;    ///< bytes after zlib, of a format that is for transmission; else 0
    std::string invalid = {};    ///< what the format's own validation found wrong; empty if nothing

    /// Numbers that `indices` may use. `vertices`: FormatSet's.
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
    std::optional<CacheFigures> best_order;  ///< of meshoptimizer's vertex-cache order; empty if absent
    RingOptions ring;                        ///< lean's
    std::vector<MeasuredFormat> formats;
    std::vector<std::pair<std::string, std::string>> absent;  ///< name, reason

    /// Divisor of bits and references per triangle: triangles without degenerate ones, at least 1.
    double triangles() const { return std::max(1.0, static_cast<double>(report.triangles)); }
};

/// The index list without degenerate triangles.
std::vector<std::uint32_t> without_degenerate(std::span<const std::uint32_t> indices);

/// Told what is made next, and which share of the work is done. false: stop, what there is so far is the result.
using FormatProgress = std::function<bool(double share, const std::string& what)>;

/// Makes every format of the mesh and decodes it again. All are of the surface; ours have a seam
/// section beside, if the mesh has seams. Errors: those of
/// build_corner_table. `paper`: the paper's procedures alone. `progress`, if given, takes the place of the bar on a
/// terminal. `quick`: only index lists, strips, lean, lr and packed, for scenes of many primitives.
Result<FormatSet> make_formats(const Mesh& mesh, const Surface& surface, const RingChoice& choice, bool paper = false,
                               const FormatProgress& progress = {}, bool quick = false);

struct FormatCheck {
    std::string name;
    std::string why;  ///< what is wrong with the format; empty: it gives back the same oriented triangles and vertices
};

/// Every format of a FormatSet, checked against the mesh that it was made of.
std::vector<FormatCheck> check_formats(const FormatSet& set, const Mesh& mesh, const Surface& surface);

}  // namespace lacedring::app
