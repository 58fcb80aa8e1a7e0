#include "lrcore/codec/packed/corridors.h"

#include "lrcore/codec/packed/polygons.h"

namespace lacedring {
namespace {

class CorridorWalker {
  public:
    CorridorWalker(const CornerTable& table, const Rings& rings)
        : table_(table), rings_(rings), polygons_(table, rings) {}

    Corridors walk() {
        out_.ring_vertices = static_cast<std::uint32_t>(rings_.edges.size());
        out_.corners.reserve(table_.triangle_count() - table_.topology.degenerate);
        out_.flags.reserve(out_.corners.capacity());
        for (std::size_t r = 0; r < rings_.count(); ++r) walk_ring(rings_.ring(r), polygons_.closing(r));
        for (std::uint32_t t = 0; t < table_.triangle_count(); ++t) {  // triangles that touch no ring
            if (!polygons_.visited(TriangleId{t}) && !table_.degenerate(TriangleId{t}))
                visit(corner(TriangleId{t}, 0), 0);
        }
        out_.vertex_order = std::move(polygons_.vertex_order());
        return std::move(out_);
    }

  private:
    /// Visits each side of the ring: first from the closing edge, which reaches all of it if it is one polygon; then
    /// the parts that borders cut off.
    void walk_ring(std::span<const RingEdge> ring, std::size_t closing) {
        for (const std::uint8_t side : {std::uint8_t{0}, std::uint8_t{CorridorStep::kRight}}) {
            const CornerId c = side == 0 ? ring[closing].left : ring[closing].right;
            if (!c.is_null() && !polygons_.visited(triangle(c))) visit(c, side);
            for (std::size_t n = 1; n <= ring.size(); ++n) {
                const RingEdge& edge = ring[(closing + n) % ring.size()];
                const CornerId part = side == 0 ? edge.left : edge.right;
                if (!part.is_null() && !polygons_.visited(triangle(part))) visit_part(part, side);
            }
        }
    }

    /// Visits the part at a ring edge. The part is entered across its border edge at the ring edge's start.
    void visit_part(CornerId c, std::uint8_t side) {
        while (true) {
            const CornerId edge = side == 0 ? next(c) : previous(c);  // faces the other edge at the start
            const CornerId o = polygons_.across(edge);
            if (o.is_null()) return visit(edge, side);
            c = o;
        }
    }

    /// Visits all triangles reachable from a corner's triangle.
    void visit(CornerId c, std::uint8_t side) {
        while (true) {
            polygons_.visit(triangle(c));
            const Polygons::Step step = polygons_.step(c, side);
            out_.corners.push_back(c);
            out_.flags.push_back(step.flags);
            CornerId then = step.a.is_null() ? step.b : step.a;
            if (!step.a.is_null() && !step.b.is_null()) {
                const bool first_a = (step.flags & CorridorStep::kFirstA) != 0;
                then = first_a ? step.a : step.b;
                stack_.push_back(first_a ? step.b : step.a);
                ++out_.events;
            }
            while (then.is_null()) {
                if (stack_.empty()) return;
                then = stack_.back();
                stack_.pop_back();
                if (polygons_.visited(triangle(then))) then = kNullCorner;  // already reached another way: a handle
            }
            c = then;
        }
    }

    const CornerTable& table_;
    const Rings& rings_;
    Polygons polygons_;
    std::vector<CornerId> stack_;
    Corridors out_;
};

}  // namespace

Corridors walk_corridors(const CornerTable& table, const Rings& rings) {
    return CorridorWalker(table, rings).walk();
}

}  // namespace lacedring
