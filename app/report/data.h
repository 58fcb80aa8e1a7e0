#pragma once
// What a report says of one mesh: the figures of `stats`, without the index lists that they were taken from.

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
    std::size_t deflated = 0;  ///< 0 where stats has none
    double bits = 0;           ///< a triangle
    double references = 0;     ///< a triangle; 0 where it has none
    double share = 0;          ///< percent of index_u32's bytes
    CacheFigures cache;
    std::string ring;  ///< what made its ring, and passes of the optimizer; empty for a format without one
};

struct ReportPicture {
    std::string view;  ///< as `render --view` calls it
    std::uint32_t width = 0, height = 0;
    std::string uri;
};

struct MeshReport {
    std::string path;
    std::size_t triangles = 0;
    std::uint32_t vertices = 0, copies = 0;  ///< of the surface, and of the mesh
    TopologyReport report;
    Topology topology;
    LeanStatistics lean;
    std::optional<CacheFigures> best_order;  ///< as in FormatSet
    std::vector<FormatFigures> formats;
    std::vector<std::pair<std::string, std::string>> absent;  ///< name, reason
    std::vector<PeriodFigures> periods;                       ///< one each of kFigure8Periods
    std::string no_periods;                                   ///< why there are none
    std::vector<ReportPicture> pictures;
    std::string no_pictures;  ///< why there are none

    const FormatFigures* find(std::string_view name) const;
};

/// Everything but the pictures. `invalid` is what a format's own validation found wrong, if anything: then it is a bug,
/// and there is no report. Errors: those of make_formats.
Result<MeshReport> measure_mesh(const std::string& path, const LoadedMesh& loaded, const RingChoice& choice,
                                std::string& invalid);

}  // namespace lacedring::app
