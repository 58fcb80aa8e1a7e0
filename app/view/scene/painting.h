#pragma once
// Colors of triangles and sides of the ring, computed from the whole mesh on a thread and cached.

#include <array>
#include <memory>
#include <vector>

#include "app/view/scene/scene.h"
#include "app/view/session/document.h"
#include "app/view/session/threads.h"

namespace lacedring::view {

/// A layer over the triangles. `ring`: only the ring's line.
enum class Paint { none, corridors, blocks, growth, ring };

/// The layer of one Paint over one document. Both vectors may be empty.
struct Painting {
    /// RGBA per triangle of the mesh; 0: not painted.
    std::vector<std::uint32_t> colors;
    /// Side of the ring, per triangle of the mesh.
    std::vector<gpu::GrowthTriangle> sides;
};

/// Cost: O(T) time; for corridors, 5 bytes per triangle of temporary memory.
Painting make_painting(const Document& document, Paint paint);

/// The corridor of each triangle (a maximal run of T1 triangles on one side of the ring), UINT32_MAX for other
/// triangles.
std::vector<std::uint32_t> corridors(const Document& document);

/// Colors of one Paint, and over them the sides of another.
struct Layers {
    Paint colors = Paint::none, sides = Paint::none;
    bool operator==(const Layers&) const = default;
};

/// Keeps the layers over the scene up to date. Makes one painting at a time, on a thread that may outlive this object.
class PaintLayer {
  public:
    struct Wanted {
        std::shared_ptr<const Document> document;
        Layers layers;
        CornerId corner = kNullCorner;          ///< the selected one
        std::uint32_t invaded = 0, newest = 0;  ///< for Scene::grow
        bool operator==(const Wanted&) const = default;
    };

    explicit PaintLayer(Threads& threads) : threads_(threads) {}

    /// Brings the scene's layers up to date. A layer that takes time to make is set by a later call; until then the old
    /// one stays. Returns whether the picture must be composed again. Errors: kDeviceFailure (no thread), too_large
    /// (memory), those of the scene; the next call tries again.
    Result<bool> update(Scene& scene, const Wanted& wanted);
    /// Returns whether the scene already shows the layers in `wanted`.
    bool laid(const Wanted& wanted) const { return !wanted.document || laid_ == wanted; }
    /// Removes all layers, before another mesh is shown.
    Result<void> clear(Scene& scene);

  private:
    static constexpr std::size_t kPaints = 5;
    struct Made {
        /// The part of the document that it was made of.
        std::shared_ptr<const void> of;
        std::shared_ptr<const Painting> painting;
    };
    struct Job;
    /// Returns the cached painting; if there is none, starts making it and returns null. Null for Paint::none.
    Result<std::shared_ptr<const Painting>> get(const std::shared_ptr<const Document>& document, Paint paint);

    Threads& threads_;
    std::array<Made, kPaints> made_;
    // Shared with its thread; null: none is running.
    std::shared_ptr<Job> job_;
    std::shared_ptr<const Painting> colors_, sides_;
    Wanted laid_;                    // the layers that the scene shows
    CornerId marked_ = kNullCorner;  // the corner whose marks the scene shows
};

}  // namespace lacedring::view
