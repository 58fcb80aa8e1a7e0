#pragma once
// Chooses the prediction of an attribute's integers by trial: the prediction with the fewest bits. Internal to lrcore.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "lrcore/codec/storage/residual_coder.h"
#include "lrcore/codec/storage/vertex_predictor.h"
#include "lrcore/codec/storage/vertex_walk.h"

namespace lacedring::storage {

/// Converts values to residuals, or back if kRestores, in the order of a walk (VertexWalk or WalkRecord).
template <bool kRestores, class Walk>
void predict(Walk& walk, const VertexParameters& parameters, std::uint32_t n, std::span<std::uint32_t> values,
             std::span<std::uint32_t> residuals) {
    with_count(n, [&]<std::uint32_t N>() {
        VertexPredictor<N, kRestores> visitor(parameters, n, values, residuals);
        walk.run(visitor);
    });
}

/// Visitor that records a VertexWalk, to run it again.
class WalkRecord {
  public:
    void start(std::uint32_t v, std::uint32_t from) { steps_.push_back({v, from, true, {}}); }
    void predicted(std::uint32_t v, const Parallelograms& by) { steps_.push_back({v, kNone, false, by}); }
    template <class Visitor>
    void run(Visitor& visitor) const {
        for (const Step& step : steps_) {
            if (step.starts) {
                visitor.start(step.v, step.from);
            } else {
                visitor.predicted(step.v, step.by);
            }
        }
    }

  private:
    struct Step {
        std::uint32_t v, from;
        bool starts;
        Parallelograms by;
    };
    std::vector<Step> steps_;
};

class ParameterSearch {
  public:
    /// `are_differences`: also try no prediction, as the values are differences already.
    ParameterSearch(const WalkRecord& walk, std::uint32_t n, std::span<std::uint32_t> values, bool are_differences)
        : walk_(walk), n_(n), values_(values), rules_(std::span(kRules).first(are_differences ? 4 : 3)) {}

    VertexParameters best() {
        find_rules();
        least_ = words(parameters_, n_, values_);
        if (n_ == 3) {
            VertexParameters with = parameters_;
            with.rules.fill(VertexRule::parallelograms);
            with.has_normal = true;
            offer(with);
        }
        vary(&VertexParameters::fine, {5, 3});
        if (parameters_.fine == 7) vary(&VertexParameters::fine, {9, 11});
        const auto end = parameters_.rules.begin() + n_;
        if (std::find(parameters_.rules.begin(), end, VertexRule::parallelograms) == end) return parameters_;
        vary(&VertexParameters::smooth, {2, 4, 6, 9});
        vary(&VertexParameters::error, {3, 6, 9});
        if (parameters_.error != 0) vary(&VertexParameters::smooth, {0, 2, 4});
        return parameters_;
    }
    /// Number of words of the values with the best parameters.
    std::size_t least() const { return least_; }

  private:
    std::size_t words(const VertexParameters& parameters, std::uint32_t n, std::span<std::uint32_t> values) const {
        Encoder coder;
        std::vector<std::uint32_t> residuals(values.size());
        predict<false>(walk_, parameters, n, values, residuals);
        code_residuals(coder, n, parameters.fine, residuals);
        return coder.finish().size();
    }

    /// Chooses the best rule of each component independently.
    void find_rules() {
        std::vector<std::uint32_t> alone(values_.size() / n_);
        for (std::uint32_t c = 0; c < n_; ++c) {
            for (std::size_t i = 0; i < alone.size(); ++i) alone[i] = values_[i * n_ + c];
            std::size_t least = SIZE_MAX;
            for (const VertexRule rule : rules_) {
                VertexParameters parameters;
                parameters.rules[0] = rule;
                const std::size_t now = words(parameters, 1, alone);
                if (now >= least) continue;
                least = now;
                parameters_.rules[c] = rule;
            }
        }
    }

    void offer(const VertexParameters& parameters) {
        const std::size_t now = words(parameters, n_, values_);
        if (now >= least_) return;
        least_ = now;
        parameters_ = parameters;
    }
    /// Tries ascending values of a parameter until a value is worse than the previous one.
    void vary(std::uint32_t VertexParameters::*which, std::initializer_list<std::uint32_t> tries) {
        for (const std::uint32_t value : tries) {
            VertexParameters with = parameters_;
            if (with.*which == value) continue;
            with.*which = value;
            const std::size_t before = least_;
            offer(with);
            if (least_ == before) return;
        }
    }

    static constexpr std::array kRules{VertexRule::parallelograms, VertexRule::mean, VertexRule::neighbor,
                                       VertexRule::none};

    const WalkRecord& walk_;
    std::uint32_t n_;
    std::span<std::uint32_t> values_;
    std::span<const VertexRule> rules_;
    VertexParameters parameters_;
    std::size_t least_ = SIZE_MAX;
};

}  // namespace lacedring::storage
