#pragma once
// Times the operators of one structure in a paged file, and checks results against the corner table's.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "app/bench/measure.h"
#include "app/bench/operator_kernels.h"
#include "lacedring/base.hpp"
#include "lrlab/pager/paged_file.h"
#include "lrlab/rivals/corner_table_c.h"
#include "lrlab/rivals/squad.h"

namespace lacedring::app {

/// In the order of ResidentFigures::Level::cells.
enum Visit {
    kScanVertex,
    kScanStep,
    kScanValence,
    kScanNormal,
    kRandomVertex,
    kRandomStep,
    kRandomValence,
    kRandomNormal,
    kContour,
    kVisits
};

/// A walk along the triangles that a plane cuts: contour_step, called `steps` times from `seed`, ends at `last`.
struct Contour {
    CornerId seed;
    std::uint32_t steps;
    CornerId last;
    double plane;
};

/// The elements to visit and the expected results, in one structure's numbering.
struct Visits {
    static constexpr std::size_t kWarmUps = 8;
    std::size_t sample = 0;  ///< elements that are timed
    // The timed sample, then kWarmUps samples that are visited before the clock starts.
    std::vector<CornerId> corners;
    std::vector<VertexId> vertices;
    // Expected results of the timed sample.
    std::vector<VertexId> vertex_of;
    std::vector<CornerId> step;  ///< opposite, or SQuad's swing
    std::vector<std::uint32_t> valence;
    std::vector<float> normal;  ///< z of the normal, not normalized
    std::vector<Contour> contours;
    std::uint64_t vertex_sum = 0, step_sum = 0, valence_sum = 0, up = 0;  ///< over all elements of the mesh
    std::size_t corner_count = 0, vertex_count = 0, contour_triangles = 0;
};

constexpr std::uint64_t summand(CornerId c) {
    return c.is_null() ? 0 : c.value + std::uint64_t{1};
}

/// Goes on to the next triangle that a plane cuts. Corner c faces the edge where the plane enters c's triangle; the
/// result faces the edge where the plane leaves it, from the next triangle. Null at a border.
template <class Ops>
CornerId contour_step(const Ops& ops, const std::vector<float>& positions, double plane, CornerId c) {
    const auto above = [&](CornerId x) { return positions[3 * std::size_t{ops.vertex(x).value}] > plane; };
    return above(c) == above(ops.next(c)) ? ops.opposite(ops.next(c)) : ops.opposite(ops.previous(c));
}

class PagedStructure {
  public:
    PagedStructure(std::string name, PagedFile file, Visits visits, std::vector<float> positions)
        : name_(std::move(name)), file_(std::move(file)), v_(std::move(visits)), positions_(std::move(positions)) {}
    PagedStructure(const PagedStructure&) = delete;
    PagedStructure& operator=(const PagedStructure&) = delete;
    virtual ~PagedStructure() = default;

    struct Timing {
        double seconds = 0;
        std::size_t operations = 0, pages = 0;
        bool right = false;  ///< the results equal the corner table's
    };
    /// Runs one kind of visit untimed, until the resident pages are those that it leaves behind, then times it once.
    Timing time(Visit visit) {
        const bool random = visit >= kRandomVertex && visit <= kRandomNormal;
        const bool fits = file_.bytes().size() <= file_.limit();
        std::size_t before = file_.pages_read();
        if (random) {  // other samples, until a limit's worth of pages has been read
            for (std::size_t i = 1; i <= Visits::kWarmUps; ++i) {
                run(visit, i);
                if (fits || file_.pages_read() - before >= file_.limit() / file_.page_bytes()) break;
            }
        } else if (!fits || visit == kContour) {  // contours are short: warm up the processor's caches, too
            run(visit, 0);
        }
        Timing out;
        before = file_.pages_read();
        out.seconds = app::seconds([&] { out.operations = run(visit, 0); });
        out.pages = file_.pages_read() - before;
        out.right = check(visit);
        return out;
    }
    /// Reads every page once. As many as the limit allows stay resident.
    void touch_all() {
        std::uint8_t sum = 0;
        for (std::size_t at = 0; at < file_.bytes().size(); at += file_.page_bytes()) {
            sum = static_cast<std::uint8_t>(sum + std::to_integer<std::uint8_t>(file_.bytes()[at]));
        }
        touched_ = sum;
    }
    const std::string& name() const { return name_; }
    PagedFile& file() { return file_; }

  protected:
    /// Visits all elements, or one sample of Visits. Returns the number of operator calls.
    virtual std::size_t run(Visit visit, std::size_t sample) = 0;

    bool check(Visit visit) const {
        const auto same = [this](const auto& expected) {
            return std::equal(expected.begin(), expected.end(), got_.begin(),
                              [](auto e, std::uint32_t g) { return e.value == g; });
        };
        switch (visit) {
            case kScanVertex:
                return sum_ == v_.vertex_sum;
            case kScanStep:
                return sum_ == v_.step_sum;
            case kScanValence:
                return sum_ == v_.valence_sum;
            case kScanNormal:  // the sign of a z near 0 depends on where the star begins
                return std::abs(static_cast<double>(sum_) - static_cast<double>(v_.up)) <=
                       2 + static_cast<double>(v_.up) * 1e-3;
            case kRandomVertex:
                return same(v_.vertex_of);
            case kRandomStep:
                return same(v_.step);
            case kRandomValence:
                return v_.valence == got_;
            case kRandomNormal:
                return std::equal(v_.normal.begin(), v_.normal.end(), normals_.begin(),
                                  [this](float e, float g) { return std::abs(e - g) <= tolerance_; });
            default:
                return sum_ == v_.contours.size();
        }
    }

    std::string name_;
    PagedFile file_;
    Visits v_;
    std::vector<float> positions_;
    std::vector<std::uint32_t> got_;
    std::vector<float> normals_;
    std::uint64_t sum_ = 0;
    float tolerance_ = 0;
    volatile std::uint8_t touched_ = 0;
};

template <class Ops>
class PagedOperators final : public PagedStructure {
  public:
    PagedOperators(std::string name, PagedFile file, Ops ops, Visits visits, std::vector<float> positions)
        : PagedStructure(std::move(name), std::move(file), std::move(visits), std::move(positions)),
          ops_(std::move(ops)) {
        got_.resize(v_.sample);
        normals_.resize(v_.sample);
        for (const float z : v_.normal) tolerance_ = std::max(tolerance_, std::abs(z) * 1e-3F);
    }

  private:
    std::size_t run(Visit visit, std::size_t sample) override {
        const std::uint32_t vertices = ops_.store().vertices;
        sum_ = 0;
        // Local copies: the compiler knows that storing a result does not change them.
        std::uint64_t sum = 0;
        const Ops ops = ops_;
        const CornerId* corners = v_.corners.data() + sample * v_.sample;
        const VertexId* random_vertices = v_.vertices.data() + sample * v_.sample;
        switch (visit) {
            case kScanVertex:
                each_corner(ops, [&](CornerId c) { sum += ops.vertex(c).value; });
                sum_ = sum;
                return v_.corner_count;
            case kScanStep:
                each_corner(ops, [&](CornerId c) { sum += summand(step_of(ops, c)); });
                sum_ = sum;
                return v_.corner_count;
            case kScanValence:
                for (std::uint32_t v = 0; v < vertices; ++v) sum += ops.valence(VertexId{v});
                sum_ = sum;
                return vertices;
            case kScanNormal:
                for (std::uint32_t v = 0; v < vertices; ++v) sum += normal_z(ops, positions_, VertexId{v}) > 0 ? 1 : 0;
                sum_ = sum;
                return vertices;
            case kRandomVertex:
                for (std::size_t i = 0; i < v_.sample; ++i) got_[i] = ops.vertex(corners[i]).value;
                return v_.sample;
            case kRandomStep:
                for (std::size_t i = 0; i < v_.sample; ++i) got_[i] = step_of(ops, corners[i]).value;
                return v_.sample;
            case kRandomValence:
                for (std::size_t i = 0; i < v_.sample; ++i) got_[i] = ops.valence(random_vertices[i]);
                return v_.sample;
            case kRandomNormal:
                for (std::size_t i = 0; i < v_.sample; ++i) normals_[i] = normal_z(ops, positions_, random_vertices[i]);
                return v_.sample;
            default:
                for (const Contour& contour : v_.contours) {
                    CornerId c = contour.seed;
                    for (std::uint32_t i = 0; i < contour.steps; ++i) {
                        c = contour_step(ops, positions_, contour.plane, c);
                    }
                    sum += c == contour.last ? 1 : 0;
                }
                sum_ = sum;
                return v_.contour_triangles;
        }
    }
    template <class Each>
    static void each_corner(const Ops& ops, Each each) {
        for (std::uint32_t t = 0; t < ops.store().triangle_numbers(); ++t) {
            // All numbers of the corner table are in use, as degenerate triangles are left out. Its is_canonical would
            // read V, and so pages.
            if constexpr (!std::is_same_v<Ops, CornerTableCView>) {
                if (!ops.is_canonical(TriangleId{t})) continue;
            }
            CornerId c = ops.corner(TriangleId{t});
            for (int k = 0; k < 3; ++k, c = ops.next(c)) each(c);
        }
    }

    Ops ops_;
};

}  // namespace lacedring::app
