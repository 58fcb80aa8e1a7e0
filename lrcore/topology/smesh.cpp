#include <cassert>

#include "lacedring/topology.hpp"
#include "lrcore/base/message.h"

namespace lacedring {
namespace {

std::string count(std::uint64_t n, const char* one, const char* many) {
    return detail::message(n, " ", n == 1 ? one : many);
}

}  // namespace

bool satisfies_equation_1(const TopologyReport& report) {
    return std::int64_t{report.triangles} == 2 * std::int64_t{report.used_vertices} - 4;
}

SmeshCheck check_smesh(const CornerTable& table, const TopologyReport& report) {
    const Topology& t = table.topology;
    if (report.triangles == 0) return {SmeshFault::empty, "no triangles"};
    if (t.degenerate > 0)
        return {SmeshFault::degenerate, count(t.degenerate, "degenerate triangle", "degenerate triangles")};
    if (t.nonmanifold_edges > 0) {
        return {SmeshFault::nonmanifold_edge, count(t.nonmanifold_edges, "non-manifold edge", "non-manifold edges")};
    }
    if (t.border_edges > 0) {
        return {SmeshFault::border, detail::message(count(t.border_edges, "border edge", "border edges"), " in ",
                                                    count(report.border_loops, "loop", "loops"))};
    }
    if (report.shells > 1) return {SmeshFault::not_connected, detail::message(report.shells, " shells")};
    // Tested before vertices: edges cut because no orientation fits also split stars into fans.
    if (!report.orientable) return {SmeshFault::not_orientable, "not orientable"};
    if (report.nonmanifold_vertices > 0) {
        return {SmeshFault::nonmanifold_vertex,
                count(report.nonmanifold_vertices, "non-manifold vertex", "non-manifold vertices")};
    }
    if (!satisfies_equation_1(report)) {
        return {SmeshFault::handles, count(static_cast<std::uint64_t>(report.genus), "handle", "handles")};
    }
    return {};
}

SmeshCheck check_smesh(const CornerTable& table, const TopologyReport& report, std::span<const ClosedShell> shells) {
    SmeshCheck check = check_smesh(table, report);
    if (!check.is_smesh()) return check;
    assert(shells.size() == 1);
    if (shells[0].flat()) return {SmeshFault::flat, "flat: it bounds no volume"};
    if (shells[0].inside_out()) return {SmeshFault::clockwise, "clockwise, that is inside out"};
    return check;
}

}  // namespace lacedring
