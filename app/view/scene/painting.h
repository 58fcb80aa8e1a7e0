#pragma once
// Colors by triangle, and sides of the ring, that take a look at the whole mesh to know. Made beside drawing, and kept
// while they are of use.

#include <array>
#include <memory>
#include <vector>

#include "app/view/scene/scene.h"
#include "app/view/session/document.h"
#include "app/view/session/threads.h"

namespace lacedring::view {

/// A layer over the triangles. `ring` is the ring's line alone.
enum class Paint { none, corridors, blocks, growth, ring };

/// The layer of one Paint over one document. Both vectors may be empty.
struct Painting {
    std::vector<std::uint32_t> colours;      ///< RGBA a triangle of the mesh; 0: as it is drawn
    std::vector<gpu::GrowthTriangle> sides;  ///< of the ring, a triangle of the mesh each
};

/// Costs: O(T) time; corridors 5 bytes a triangle while they are made.
Painting make_painting(const Document& document, Paint paint);

/// The corridor of each triangle (a maximal run of T1 triangles on one side of the ring), UINT32_MAX for other
/// triangles.
std::vector<std::uint32_t> corridors(const Document& document);

/// Colors of one Paint, and sides of another one over them.
struct Layers {
    Paint colours = Paint::none, sides = Paint::none;
    bool operator==(const Layers&) const = default;
};

/// Keeps up what the scene lays over a document. Makes one painting at a time, on a thread that may outlive this.
class PaintLayer {
  public:
    struct Wanted {
        std::shared_ptr<const Document> document;
        Layers layers;
        CornerId corner = kNullCorner;          ///< selected
        std::uint32_t invaded = 0, newest = 0;  ///< Scene::grow
        bool operator==(const Wanted&) const = default;
    };

    explicit PaintLayer(Threads& threads) : threads_(threads) {}

    /// Brings the scene up to date; what takes time to make is laid by a later call, and what was there stays until
    /// then. True: the picture has to be composed again. Errors: kDeviceFailure (no thread), too_large (memory), and
    /// those of the scene; the next call tries again.
    Result<bool> update(Scene& scene, const Wanted& wanted);
    bool laid(const Wanted& wanted) const { return !wanted.document || laid_ == wanted; }
    /// Takes everything away: it is of another mesh.
    Result<void> clear(Scene& scene);

  private:
    static constexpr std::size_t kPaints = 5;
    struct Made {
        std::shared_ptr<const void> of;  ///< the part of the document that it shows
        std::shared_ptr<const Painting> painting;
    };
    struct Job;
    /// The painting of a layer, or null while it is being made and for Paint::none.
    Result<std::shared_ptr<const Painting>> get(const std::shared_ptr<const Document>& document, Paint paint);

    Threads& threads_;
    std::array<Made, kPaints> made_;
    std::shared_ptr<Job> job_;  // with its thread; null: nothing is being made
    std::shared_ptr<const Painting> colours_, sides_;
    Wanted laid_;
    CornerId marked_ = kNullCorner;  // whose marks are laid
};

}  // namespace lacedring::view
