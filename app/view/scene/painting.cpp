#include "app/view/scene/painting.h"

#include <atomic>
#include <new>
#include <utility>

#include "app/view/scene/selection.h"
#include "lacedring/ring.hpp"
#include "lacedring/streams.hpp"
#include "renderer/mesh/triangle_class.h"

namespace lacedring::view {
namespace {

/// Colours that neighbouring numbers do not share.
std::uint32_t hashed(std::uint32_t i) {
    constexpr std::array<std::uint32_t, 12> kColours{rgba(214, 96, 60),   rgba(66, 140, 196),  rgba(232, 184, 92),
                                                     rgba(96, 164, 108),  rgba(146, 104, 182), rgba(196, 70, 98),
                                                     rgba(98, 186, 190),  rgba(170, 150, 84),  rgba(120, 130, 210),
                                                     rgba(222, 140, 160), rgba(140, 186, 84),  rgba(160, 110, 80)};
    return kColours[(i * 2654435761U >> 8) % kColours.size()];
}

std::vector<gpu::GrowthTriangle> growth(const Document& document) {
    const CornerTable& table = *document.table;
    const std::vector<std::uint32_t> steps = settling_steps(table, *document.expansion);
    std::vector<gpu::GrowthTriangle> out(steps.size());
    for (std::uint32_t t = 0; t < out.size(); ++t) {
        std::uint32_t across[3];
        for (std::uint32_t k = 0; k < 3; ++k) {
            const CornerId o = table.opposite(corner(TriangleId{t}, k));
            across[k] = o.is_null() ? LR_GROWTH_BORDER : triangle(o).value;
        }
        static_assert(LR_GROWTH_RIGHT == kNeverInvaded);
        out[t] = {steps[t], {across[0], across[1], across[2]}};
    }
    return out;
}

/// The part of a document that a painting shows: another document with the same part has the same painting.
std::shared_ptr<const void> part(const Document& document, Paint paint) {
    if (paint == Paint::growth) return document.expansion;
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
                // On the same side: across a ring edge lies the other one.
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
        out.colours = corridors(document);
        for (std::uint32_t& c : out.colours) c = c == UINT32_MAX ? rgba(176, 176, 176) : hashed(c);
    } else if (paint == Paint::blocks) {
        const std::vector<std::uint32_t>& order = document.model->packed.triangle_order;
        out.colours.resize(document.mesh->triangle_count());
        for (std::uint32_t i = 0; i < order.size(); ++i) out.colours[order[i]] = hashed(i / 256);
    } else if (paint == Paint::growth) {
        out.growth = growth(document);
    }
    return out;
}

struct Paintings::Job {
    std::atomic<bool> done = false;
    std::shared_ptr<const Painting> painting;  // once done; null: there was not enough memory
};

Result<std::shared_ptr<const Painting>> Paintings::get(const std::shared_ptr<const Document>& document, Paint paint) {
    if (job_ && job_->done) {
        const std::shared_ptr<Job> job = std::exchange(job_, nullptr);
        if (!job->painting) return Error{ErrorCode::too_large, "not enough memory for these colours"};
        made_[static_cast<std::size_t>(job_paint_)] = {std::move(job_of_), job->painting};
    }
    for (std::size_t i = 0; i < kPaints; ++i) {  // nothing of another mesh or ring is kept
        if (made_[i].of != part(*document, static_cast<Paint>(i))) made_[i] = {};
    }
    if (paint == Paint::none) return std::shared_ptr<const Painting>();
    const Made& made = made_[static_cast<std::size_t>(paint)];
    if (made.painting || job_) return made.painting;
    auto job = std::make_shared<Job>();
    const Result<void> started = threads_.start([job, document, paint] {
        try {
            job->painting = std::make_shared<const Painting>(make_painting(*document, paint));
        } catch (const std::bad_alloc&) {
            job->painting.reset();
        }
        job->done = true;
    });
    if (!started) return started.error();
    job_ = std::move(job);
    job_paint_ = paint;
    job_of_ = part(*document, paint);
    return std::shared_ptr<const Painting>();
}

}  // namespace lacedring::view
