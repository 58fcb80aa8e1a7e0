#pragma once
// Colours by triangle that take a look at the whole mesh to know. Made beside drawing, and kept while they are of use.

#include <array>
#include <memory>
#include <vector>

#include "app/view/session/document.h"
#include "app/view/session/threads.h"
#include "shaders/viewer/compose_shared.h"

namespace lacedring::view {

/// What is laid over the triangles.
enum class Paint { none, corridors, blocks, growth };
constexpr std::array<gpu::Named<Paint>, 4> kPaints{{{"none", Paint::none, "none"},
                                                    {"corridors", Paint::corridors, "corridors"},
                                                    {"blocks", Paint::blocks, "blocks"},
                                                    {"growth", Paint::growth, "ring-expander"}}};

/// What one Paint lays over one document. Either may be empty.
struct Painting {
    std::vector<std::uint32_t> colours;       ///< RGBA a triangle of the mesh; 0: as it is drawn
    std::vector<gpu::GrowthTriangle> growth;  ///< a triangle of the mesh each
};

/// Costs: O(T) time; corridors 5 bytes a triangle while they are made.
Painting make_painting(const Document& document, Paint paint);

/// The corridor of each triangle (a maximal run of T1 triangles on one side of the ring), UINT32_MAX for other
/// triangles.
std::vector<std::uint32_t> corridors(const Document& document);

/// Makes one painting at a time, on a thread beside the window's, which may outlive this.
class Paintings {
  public:
    explicit Paintings(Threads& threads) : threads_(threads) {}

    /// The document's, if it is made; null while it is being made, which this begins, and for Paint::none. One that is
    /// asked for again is made once. Errors: kDeviceFailure (no thread), too_large (not enough memory); the next call
    /// tries again.
    Result<std::shared_ptr<const Painting>> get(const std::shared_ptr<const Document>& document, Paint paint);

  private:
    static constexpr std::size_t kPaints = 4;
    struct Made {
        std::shared_ptr<const void> of;  ///< what of the document it shows
        std::shared_ptr<const Painting> painting;
    };
    struct Job;

    Threads& threads_;
    std::array<Made, kPaints> made_;
    std::shared_ptr<Job> job_;  // with its thread; null: nothing is being made
    Paint job_paint_ = Paint::none;
    std::shared_ptr<const void> job_of_;
};

}  // namespace lacedring::view
