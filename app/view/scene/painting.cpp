#include "app/view/scene/painting.h"

#include <atomic>
#include <new>
#include <utility>

#include "app/view/scene/selection.h"
#include "lacedring/ring.hpp"
#include "lacedring/streams.hpp"
#include "renderer/mesh/triangle_class.h"
#include "renderer/vk/try.h"

namespace lacedring::view {
namespace {

/// A color for a number; neighboring numbers mostly get different colors.
std::uint32_t hashed(std::uint32_t i) {
    constexpr std::array<std::uint32_t, 12> kColors{rgba(214, 96, 60),   rgba(66, 140, 196),  rgba(232, 184, 92),
                                                    rgba(96, 164, 108),  rgba(146, 104, 182), rgba(196, 70, 98),
                                                    rgba(98, 186, 190),  rgba(170, 150, 84),  rgba(120, 130, 210),
                                                    rgba(222, 140, 160), rgba(140, 186, 84),  rgba(160, 110, 80)};
    return kColors[(i * 2654435761U >> 8) % kColors.size()];
}

std::vector<gpu::GrowthTriangle> triangles_across(const CornerTable& table) {
    std::vector<gpu::GrowthTriangle> out(table.triangle_count());
    for (std::uint32_t t = 0; t < out.size(); ++t) {
        for (std::uint32_t k = 0; k < 3; ++k) {
            const CornerId o = table.opposite(corner(TriangleId{t}, k));
            out[t].across[k] = o.is_null() ? LR_GROWTH_BORDER : triangle(o).value;
        }
    }
    return out;
}

std::vector<gpu::GrowthTriangle> growth(const Document& document) {
    static_assert(LR_GROWTH_RIGHT == kNeverInvaded);
    std::vector<gpu::GrowthTriangle> out = triangles_across(*document.table);
    const std::vector<std::uint32_t> steps = settling_steps(*document.table, *document.expansion);
    for (std::size_t t = 0; t < out.size(); ++t) out[t].step = steps[t];
    return out;
}

/// Finds for each triangle whether it is left or right of the finished rings. Triangles that are connected without
/// crossing a ring are on the same side.
std::vector<gpu::GrowthTriangle> ring_sides(const Document& document) {
    const CornerTable& table = *document.table;
    std::vector<gpu::GrowthTriangle> out = triangles_across(table);
    std::vector<bool> crossed(table.corners.size());
    std::vector<std::uint32_t> stack;
    for (gpu::GrowthTriangle& t : out) t.step = LR_GROWTH_RIGHT;
    const auto reach = [&](CornerId c) {
        gpu::GrowthTriangle& t = out[triangle(c).value];
        if (t.step == 0) return;
        t.step = 0;
        stack.push_back(triangle(c).value);
    };
    for (const RingEdge& edge : document.rings->edges) {
        crossed[edge.left.value] = true;
        if (!edge.right.is_null()) crossed[edge.right.value] = true;
    }
    for (const RingEdge& edge : document.rings->edges) reach(edge.left);
    while (!stack.empty()) {
        const TriangleId t{stack.back()};
        stack.pop_back();
        for (std::uint32_t k = 0; k < 3; ++k) {
            const CornerId c = corner(t, k);
            if (!crossed[c.value] && !table.opposite(c).is_null()) reach(table.opposite(c));
        }
    }
    return out;
}

/// The part of a document that a painting is made of. Documents that share it have the same painting.
std::shared_ptr<const void> part(const Document& document, Paint paint) {
    if (paint == Paint::growth) return document.expansion;
    if (paint == Paint::ring) return document.rings;
    return document.model;
}

}  // namespace

std::vector<std::uint32_t> corridors(const Document& document) {
    const CornerTable& table = *document.table;
    std::vector<std::uint32_t> out(table.triangle_count(), UINT32_MAX);
    const std::vector<std::uint8_t> classes = gpu::of_triangles(
        gpu::slot_classes(document.views.lean), document.model->lean.slot_triangle, table.triangle_count());
    const auto corridor = [&](std::uint32_t t) {
        return classes[t] == LR_CLASS_T1_LEFT || classes[t] == LR_CLASS_T1_RIGHT;
    };
    std::uint32_t count = 0;
    std::vector<std::uint32_t> stack;
    for (std::uint32_t first = 0; first < out.size(); ++first) {
        if (out[first] != UINT32_MAX || !corridor(first)) continue;
        stack.push_back(first);
        out[first] = count;
        while (!stack.empty()) {
            const std::uint32_t t = stack.back();
            stack.pop_back();
            for (std::uint32_t i = 0; i < 3; ++i) {
                const CornerId o = table.opposite(corner(TriangleId{t}, i));
                // A neighbor of the same class is on the same side: across a ring edge is a triangle of the other.
                if (o.is_null() || classes[triangle(o).value] != classes[t]) continue;
                std::uint32_t& there = out[triangle(o).value];
                if (there != UINT32_MAX) continue;
                there = count;
                stack.push_back(triangle(o).value);
            }
        }
        ++count;
    }
    return out;
}

Painting make_painting(const Document& document, Paint paint) {
    Painting out;
    if (paint == Paint::corridors) {
        out.colors = corridors(document);
        for (std::uint32_t& c : out.colors) c = c == UINT32_MAX ? rgba(176, 176, 176) : hashed(c);
    } else if (paint == Paint::blocks) {
        const std::vector<std::uint32_t>& order = document.model->packed.triangle_order;
        out.colors.resize(document.mesh->triangle_count());
        for (std::uint32_t i = 0; i < order.size(); ++i) out.colors[order[i]] = hashed(i / 256);
    } else if (paint == Paint::growth) {
        out.sides = growth(document);
    } else if (paint == Paint::ring) {
        out.sides = ring_sides(document);
    }
    return out;
}

struct PaintLayer::Job {
    Paint paint = Paint::none;
    std::shared_ptr<const void> of;
    std::atomic<bool> done = false;
    // Set before `done`; null: not enough memory.
    std::shared_ptr<const Painting> painting;
};

Result<std::shared_ptr<const Painting>> PaintLayer::get(const std::shared_ptr<const Document>& document, Paint paint) {
    if (job_ && job_->done) {
        const std::shared_ptr<Job> job = std::exchange(job_, nullptr);
        if (!job->painting) return Error{ErrorCode::too_large, "not enough memory for these colors"};
        made_[static_cast<std::size_t>(job->paint)] = {job->of, job->painting};
    }
    for (std::size_t i = 0; i < kPaints; ++i) {  // drop paintings of another mesh or ring
        if (made_[i].of != part(*document, static_cast<Paint>(i))) made_[i] = {};
    }
    if (paint == Paint::none) return std::shared_ptr<const Painting>();
    const Made& made = made_[static_cast<std::size_t>(paint)];
    if (made.painting || job_) return made.painting;
    auto job = std::make_shared<Job>();
    job->paint = paint;
    job->of = part(*document, paint);
    const Result<void> started = threads_.start([job, document] {
        try {
            job->painting = std::make_shared<const Painting>(make_painting(*document, job->paint));
        } catch (const std::bad_alloc&) {
            job->painting.reset();
        }
        job->done = true;
    });
    if (!started) return started.error();
    job_ = std::move(job);
    return std::shared_ptr<const Painting>();
}

Result<void> PaintLayer::clear(Scene& scene) {
    colors_.reset();
    sides_.reset();
    marked_ = kNullCorner;
    laid_ = {};
    LR_TRY(scene.set_sides({}, false));
    return scene.set_paint({});
}

Result<bool> PaintLayer::update(Scene& scene, const Wanted& wanted) {
    if (laid(wanted)) return false;
    bool made = true;
    const auto [color_paint, side_paint] = wanted.layers;
    LR_ASSIGN(const std::shared_ptr<const Painting> colors, get(wanted.document, color_paint));
    if (colors || color_paint == Paint::none) {
        if (colors != colors_) {
            LR_TRY(scene.set_paint(colors ? colors->colors : std::span<const std::uint32_t>{}));
            marked_ = kNullCorner;
        }
        colors_ = colors;
    } else {
        made = false;
    }
    LR_ASSIGN(const std::shared_ptr<const Painting> sides, get(wanted.document, side_paint));
    if (sides || side_paint == Paint::none) {
        if (sides != sides_) {
            LR_TRY(scene.set_sides(sides ? sides->sides : std::span<const gpu::GrowthTriangle>{},
                                   side_paint == Paint::growth));
        }
        sides_ = sides;
        if (side_paint == Paint::ring) {
            scene.grow(1, 0);
        } else {
            scene.grow(wanted.invaded, wanted.newest);
        }
    } else {
        made = false;
    }
    const bool marks = marked_ != wanted.corner;
    if (marks) LR_TRY(scene.set_marks(selection_marks(*wanted.document, wanted.corner)));
    marked_ = wanted.corner;
    if (made) laid_ = wanted;
    return made || marks;
}

}  // namespace lacedring::view
