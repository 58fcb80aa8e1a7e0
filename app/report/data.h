#pragma once
// The figures of one mesh in a report: those of `stats`, without the index lists.

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/cli/input.h"
#include "app/formats/formats.h"
#include "app/formats/notes.h"
#include "app/report/paper_tables.h"
#include "lacedring/lacedring.hpp"

namespace lacedring::app {

struct FormatFigures {
    std::string name;
    std::size_t bytes = 0;
    std::size_t deflated = 0;  ///< 0 if the format is not deflated
    double bits = 0;           ///< per triangle
    double references = 0;     ///< per triangle; 0 if the format has none
    double share = 0;          ///< percent of index_u32's bytes
    CacheFigures cache;
    /// The expander that made its ring, and the optimizer's passes; empty for a format without a ring.
    std::string ring;
};

struct ReportPicture {
    std::string view;  ///< a name of `render --view`
    std::uint32_t width = 0, height = 0;
    std::string uri;
};

struct MeshReport {
    std::string path;
    std::size_t triangles = 0;
    std::uint32_t vertices = 0;  ///< of the surface
    std::uint32_t copies = 0;    ///< vertices of the mesh
    TopologyReport report;
    Topology topology;
    LeanStatistics lean;
    std::optional<CacheFigures> best_order;  ///< FormatSet::best_order
    std::vector<FormatFigures> formats;
    std::vector<std::pair<std::string, std::string>> absent;  ///< name, reason
    std::vector<PeriodFigures> periods;                       ///< one per entry of kFigure8Periods
    std::string no_periods;                                   ///< why `periods` is empty
    std::vector<ReportPicture> pictures;
    std::string no_pictures;  ///< why `pictures` is empty

    const FormatFigures* find(std::string_view name) const;
};

/// Measures everything except the pictures. If a format fails its own validation (a bug), sets `invalid` to the reason;
/// the result is then incomplete. Errors: those of make_formats.
Result<MeshReport> measure_mesh(const std::string& path, const LoadedMesh& loaded, const RingChoice& choice,
                                std::string& invalid);

}  // namespace lacedring::app
