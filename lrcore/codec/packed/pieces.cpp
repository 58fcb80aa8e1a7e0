// The order for the vertex cache. A corridor is a strip of triangles between two chains of ring vertices; in a long
// corridor every triangle needs a new vertex. Other corridors lie beside it, across the ring edges of its chains. The
// next piece is taken from one of these, along the same chain, so that only the vertices of its other chain are new.

#include <algorithm>
#include <array>

#include "lrcore/codec/packed/corridors.h"
#include "lrcore/codec/packed/polygons.h"

namespace lacedring {
namespace {

constexpr std::uint32_t kCache = 32;
// Minimum triangles of a piece: one of its chains and the next piece's other chain fit in the cache.
constexpr std::size_t kPiece = 31;
// If at most this many triangles are left of a corridor or past a T0, they join the piece.
constexpr std::uint32_t kWhole = 8;
constexpr double kStart = 12;  // cost of starting a piece, in vertices

class PieceWalker {
  public:
    PieceWalker(const CornerTable& table, const Rings& rings)
        : table_(table), rings_(rings), polygons_(table, rings), inserted_(table.vertex_count, 0) {}

    Corridors walk() {
        out_.ring_vertices = static_cast<std::uint32_t>(rings_.edges.size());
        out_.corners.reserve(table_.triangle_count() - table_.topology.degenerate);
        out_.flags.reserve(out_.corners.capacity());
        for (std::size_t r = 0; r < rings_.count(); ++r) {
            const std::span<const RingEdge> ring = rings_.ring(r);
            const RingEdge& closing = ring[polygons_.closing(r)];  // small components need no START event there
            sweep(closing.left, 0);
            sweep(closing.right, CorridorStep::kRight);
            for (const RingEdge& edge : ring) {
                sweep(next(edge.left), 0);
                if (!edge.right.is_null()) sweep(previous(edge.right), CorridorStep::kRight);
            }
        }
        for (std::uint32_t t = 0; t < table_.triangle_count(); ++t) {
            if (!table_.degenerate(TriangleId{t})) sweep(corner(TriangleId{t}, 0), 0);
        }
        out_.vertex_order = std::move(polygons_.vertex_order());
        spread_scraps();
        return std::move(out_);
    }

  private:
    struct Start {
        CornerId corner = kNullCorner;
        std::uint8_t side = 0;
    };
    struct Piece {
        std::vector<CornerId> corners;
        std::vector<std::uint8_t> flags;
        // Vertices that were not in the cache; `before` has their previous times of insertion.
        std::vector<std::uint32_t> inserted;
        std::vector<std::uint32_t> before;
        double score = 0;
    };

    /// Visits piece after piece, each beside the last, until no start is left.
    void sweep(CornerId c, std::uint8_t side) {
        if (c.is_null() || polygons_.visited(triangle(c))) return;
        Start start{c, side};
        while (!start.corner.is_null()) {
            grow(start, best_);
            begins_.push_back(static_cast<std::uint32_t>(out_.corners.size()));
            out_.corners.insert(out_.corners.end(), best_.corners.begin(), best_.corners.end());
            out_.flags.insert(out_.flags.end(), best_.flags.begin(), best_.flags.end());
            start = next_start(best_);
        }
    }

    /// Moves pieces of very few triangles to directly after a piece that they touch. In sequence they would need too
    /// many events per block, and each would load its vertices again.
    void spread_scraps() {
        constexpr std::uint32_t kScrap = 8;
        const auto pieces = static_cast<std::uint32_t>(begins_.size());
        begins_.push_back(static_cast<std::uint32_t>(out_.corners.size()));
        std::vector<std::uint32_t> piece_of(table_.triangle_count(), UINT32_MAX);
        std::vector<std::uint32_t> behind(pieces), order(pieces);
        for (std::uint32_t p = 0; p < pieces; ++p) {
            order[p] = behind[p] = p;
            for (std::uint32_t i = begins_[p]; i < begins_[p + 1]; ++i) piece_of[triangle(out_.corners[i]).value] = p;
        }
        for (std::uint32_t p = 0; p < pieces; ++p) {
            if (begins_[p + 1] - begins_[p] > kScrap) continue;
            std::uint32_t touched = 0;
            for (std::uint32_t i = begins_[p]; i < begins_[p + 1]; ++i) {
                const CornerId c = out_.corners[i];
                for (const CornerId k : {c, next(c), previous(c)}) {
                    const CornerId o = table_.opposite(k);
                    if (o.is_null()) continue;
                    const std::uint32_t q = piece_of[triangle(o).value];
                    if (q < p && behind[q] == q) touched = std::max(touched, q);
                }
            }
            if (touched > 0) behind[p] = touched;
        }
        std::stable_sort(order.begin(), order.end(),
                         [&](std::uint32_t p, std::uint32_t q) { return behind[p] < behind[q]; });
        Corridors sorted;
        sorted.corners.reserve(out_.corners.size());
        sorted.flags.reserve(out_.flags.size());
        for (const std::uint32_t p : order) {
            sorted.corners.insert(sorted.corners.end(), out_.corners.begin() + begins_[p],
                                  out_.corners.begin() + begins_[p + 1]);
            sorted.flags.insert(sorted.flags.end(), out_.flags.begin() + begins_[p],
                                out_.flags.begin() + begins_[p + 1]);
        }
        out_.corners = std::move(sorted.corners);
        out_.flags = std::move(sorted.flags);
    }

    /// The best start beside a piece, by the score of a trial piece grown there.
    Start next_start(const Piece& piece) {
        std::array<Start, 10> candidates;
        std::size_t count = 0;
        const std::uint8_t side = piece.flags.front() & CorridorStep::kRight;
        const std::uint8_t other = side ^ CorridorStep::kRight;
        const auto add = [&](std::size_t i) {
            for (const CornerId c : {piece.corners[i], next(piece.corners[i]), previous(piece.corners[i])}) {
                if (!polygons_.on_ring(c)) continue;
                const CornerId o = table_.opposite(c);
                if (o.is_null() || polygons_.visited(triangle(o)) || count + 2 > candidates.size()) continue;
                candidates[count++] = {back(next(o), other), other};
                candidates[count++] = {back(previous(o), other), other};
                return true;
            }
            return false;
        };
        // Candidates are the first two ring edges with an unvisited triangle beside them, from each end of the piece
        // and on each chain.
        const std::size_t n = piece.corners.size();
        std::size_t found = 0;
        for (std::size_t i = 0; i < n && found < 2; ++i) found += add(i) ? 1 : 0;
        for (std::size_t i = n; i > 0 && found < 4; --i) found += add(i - 1) ? 1 : 0;
        const Polygons::Step last = polygons_.step(piece.corners.back(), side);
        for (const CornerId c : {last.a, last.b}) {
            if (!c.is_null() && count < candidates.size()) candidates[count++] = {c, side};
        }
        Start best;
        double best_score = 1e9;
        for (std::size_t i = 0; i < count; ++i) {
            grow(candidates[i], trial_);
            undo(trial_);
            if (trial_.score >= best_score) continue;
            best_score = trial_.score;
            best = candidates[i];
        }
        return best;
    }

    /// Does the corridor that continues at c end within kWhole triangles?
    bool ends_soon(CornerId c, std::uint8_t side) const {
        for (std::uint32_t i = 0; i < kWhole; ++i) {
            const Polygons::Step step = polygons_.step(c, side);
            if (!step.a.is_null() && !step.b.is_null()) return false;
            c = step.a.is_null() ? step.b : step.a;
            if (c.is_null()) return true;
        }
        return false;
    }

    /// The beginning of the corridor entered at c, if it is at most kWhole triangles back; else c.
    CornerId back(CornerId c, std::uint8_t side) const {
        CornerId at = c;
        for (std::uint32_t i = 0; i < kWhole; ++i) {
            const CornerId o = polygons_.across(at);
            if (o.is_null()) return at;
            const Polygons::Step step = polygons_.step(o, side);
            if (!step.a.is_null() && !step.b.is_null()) return at;
            if (step.a.is_null() && step.b.is_null()) return polygons_.on_ring(next(o)) ? previous(o) : next(o);
            // The corridor continues across the edge facing next(o).
            const bool by_next = step.a.is_null() == (side == 0);
            at = by_next ? next(o) : previous(o);
        }
        return c;
    }

    void touch(std::uint32_t v, Piece& piece) {
        if (time_ - inserted_[v] < kCache && inserted_[v] != 0) return;
        piece.inserted.push_back(v);
        piece.before.push_back(inserted_[v]);
        inserted_[v] = ++time_;
    }

    /// Grows a piece from `start`.
    void grow(Start start, Piece& piece) {
        piece.corners.clear();
        piece.flags.clear();
        piece.inserted.clear();
        piece.before.clear();
        CornerId c = start.corner, then = kNullCorner;
        while (true) {
            polygons_.visit(triangle(c));
            const Polygons::Step step = polygons_.step(c, start.side);
            piece.corners.push_back(c);
            piece.flags.push_back(step.flags);
            for (const CornerId k : {c, next(c), previous(c)}) touch(table_.vertex(k).value, piece);
            CornerId after = step.a.is_null() ? step.b : step.a;
            if (!step.a.is_null() && !step.b.is_null()) {
                const bool first_a = (step.flags & CorridorStep::kFirstA) != 0;
                after = first_a ? step.a : step.b;
                const std::uint32_t x = polygons_.number(c);
                const std::uint32_t from = polygons_.number(start.side == 0 ? (first_a ? next(c) : previous(c))
                                                                            : (first_a ? previous(c) : next(c)));
                const std::uint32_t size = first_a ? x - from : from - x;
                if (!then.is_null() || size > kWhole) break;  // a T0 with two long parts ends the piece
                then = first_a ? step.b : step.a;
            }
            if (after.is_null()) {
                after = then;
                then = kNullCorner;
                if (!after.is_null() && polygons_.visited(triangle(after))) after = kNullCorner;
            }
            if (after.is_null()) break;
            if (piece.corners.size() >= kPiece && then.is_null() && !ends_soon(after, start.side)) break;
            c = after;
        }
        piece.score = (kStart + static_cast<double>(piece.inserted.size())) / static_cast<double>(piece.corners.size());
    }

    void undo(const Piece& piece) {
        for (const CornerId c : piece.corners) polygons_.leave(triangle(c));
        for (std::size_t i = piece.inserted.size(); i > 0; --i) inserted_[piece.inserted[i - 1]] = piece.before[i - 1];
        time_ -= static_cast<std::uint32_t>(piece.inserted.size());
    }

    const CornerTable& table_;
    const Rings& rings_;
    Polygons polygons_;
    // Time of insertion into the cache by the mesh's vertex; 0: never.
    std::vector<std::uint32_t> inserted_;
    std::uint32_t time_ = 0;
    std::vector<std::uint32_t> begins_;  // first step of each piece
    Piece best_, trial_;
    Corridors out_;
};

}  // namespace

Corridors walk_pieces(const CornerTable& table, const Rings& rings) {
    Corridors out = PieceWalker(table, rings).walk();
    out.events += static_cast<std::uint32_t>(out.corners.size() / kPiece);
    return out;
}

}  // namespace lacedring
