#include "lrcore/codec/storage/vertex_storage.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cstring>
#include <type_traits>

#include "lrcore/base/message.h"
#include "lrcore/codec/storage/block_coder.h"
#include "lrcore/codec/storage/normal_base.h"
#include "lrcore/codec/storage/place_prediction.h"
#include "lrcore/codec/storage/vertex_values.h"

namespace lacedring::storage {
namespace {

using Words = std::vector<std::uint32_t>;

constexpr std::uint32_t kLayoutBits = 23;

/// All of a stream.
struct StoredStream {
    std::uint32_t vertices = 0;
    StreamChoices choices;
    VertexParameters parameters;
    bool by_places = false;  // the integers are differences from what the positions lead one to expect
    NormalBase base;         // of normals
    Words exceptions;        // two words each
    Words values;
    std::vector<BlockChoices> blocks;  // of an encoder alone

    std::uint32_t components() const { return choices.layout & 31; }
    std::uint32_t mapping() const { return choices.layout >> 5 & 7; }
    std::uint32_t bits() const { return choices.layout >> 13 & 31; }
    bool is_octahedral() const { return static_cast<VertexMapping>(mapping()) == VertexMapping::octahedral; }
};

Error malformed_vertices(const char* what) {
    return {ErrorCode::malformed, detail::message("stored vertex stream: ", what)};
}

/// Codes how two integers a vertex are predicted by positions.
template <class Coder>
bool code_places(Coder& coder, StoredStream& stream) {
    if (stream.components() != 2) return true;
    stream.by_places = coder.raw(stream.by_places ? 1 : 0, 1) != 0;
    if (!stream.by_places || !stream.is_octahedral()) return true;
    for (bool NormalBase::*flag : {&NormalBase::by_angle, &NormalBase::by_area, &NormalBase::of_vertex})
        stream.base.*flag = coder.raw(stream.base.*flag ? 1 : 0, 1) != 0;
    return stream.bits() >= 2 && stream.bits() <= 16;
}

/// Codes what a stream says before its integers, which a Decoder does not know yet: `has_usual_ranges` then says
/// whether find_vertex_ranges gives the ranges.
template <class Coder>
bool code_header(Coder& coder, StoredStream& stream, bool& has_usual_ranges) {
    StreamChoices& choices = stream.choices;
    choices.layout = coder.raw(choices.layout, kLayoutBits);
    const std::uint32_t n = stream.components();
    if (n == 0 || n > kMostComponents) return false;
    const auto mapping = static_cast<VertexMapping>(stream.mapping());
    if (mapping == VertexMapping::lattice) choices.lattice = coder.raw(choices.lattice, 32);
    if (mapping == VertexMapping::decimals) choices.lattice = coder.raw(choices.lattice, 4);
    if (mapping == VertexMapping::lattice || mapping == VertexMapping::octahedral)
        choices.error = coder.raw(choices.error, 32);
    has_usual_ranges = coder.raw(has_usual_ranges ? 1 : 0, 1) != 0;
    choices.components.resize(n);
    for (VertexComponent& c : choices.components) {
        c.width = coder.raw(c.width, 5);
        c.predictor = coder.raw(c.predictor, 5);
        if (has_usual_ranges) continue;
        c.low = coder.raw(c.low, 32);
        c.first_bits = coder.raw(c.first_bits, 6);
        if (c.first_bits > 32) return false;
    }
    VertexParameters& p = stream.parameters;
    for (std::uint32_t c = 0; c < n; ++c)
        p.rules[c] = static_cast<VertexRule>(coder.raw(static_cast<std::uint32_t>(p.rules[c]), 2));
    p.has_normal = coder.raw(p.has_normal ? 1 : 0, 1) != 0;
    p.error = coder.raw(p.error, 4);
    p.smooth = coder.raw(p.smooth, 5);
    p.fine = coder.raw(p.fine, 4);
    return code_places(coder, stream) && p.smooth <= 16 && !(p.has_normal && n != 3);
}

template <class Coder>
bool code_exceptions(Coder& coder, StoredStream& stream) {
    if (static_cast<VertexMapping>(stream.mapping()) != VertexMapping::decimals) return true;
    const std::uint32_t count = coder.raw(static_cast<std::uint32_t>(stream.exceptions.size() / 2), 32);
    NumberModel distance;
    BitModel same;
    std::uint64_t next = 0;            // the least number that the exception may have
    std::uint32_t last = 0x80000000U;  // -0, the usual one
    for (std::uint32_t i = 0; i < count; ++i) {
        if constexpr (Coder::kDecodes) stream.exceptions.resize(2 * std::size_t{i} + 2);
        std::uint32_t* at = stream.exceptions.data() + 2 * std::size_t{i};
        const std::uint64_t number = next + distance.code(coder, at[0] - static_cast<std::uint32_t>(next));
        if (number >= stream.values.size() || number > UINT32_MAX || coder.bad()) return false;
        at[0] = static_cast<std::uint32_t>(number);
        if (coder.bit(same, at[1] != last ? 1 : 0) != 0) last = coder.raw(at[1], 32);
        at[1] = last;
        next = number + 1;
    }
    return true;
}

/// Calls what(coder) with a VertexValueCoder for the number of components.
template <class Coder, class What>
void with_values(Coder& coder, const VertexParameters& parameters, std::uint32_t n, std::span<std::uint32_t> values,
                 What&& what) {
    const auto run = [&]<std::uint32_t N>() {
        VertexValueCoder<Coder, N> visitor(coder, parameters, n, values);
        what(visitor);
    };
    switch (n) {
        case 1:
            return run.template operator()<1>();
        case 2:
            return run.template operator()<2>();
        case 3:
            return run.template operator()<3>();
        case 4:
            return run.template operator()<4>();
        default:
            return run.template operator()<0>();
    }
}

/// Codes and writes the blocks; `begins` gets the bit where each begins.
template <class Coder>
bool code_blocks(Coder& coder, StoredStream& stream, std::uint64_t most_words, BlockBits& out,
                 std::vector<std::uint64_t>& begins) {
    BlockCoder<Coder> blocks(coder, stream.choices.components, out);
    const std::uint32_t n = stream.components();
    for (std::uint32_t first = 0; first < stream.vertices;) {
        if (begins.size() % kVertexGroup == 0) out.align();
        if (out.words() > most_words || coder.bad()) return false;
        const std::uint32_t count = std::min(stream.vertices - first, kVertexBlock);
        BlockChoices own;
        BlockChoices& choices = Coder::kDecodes ? own : stream.blocks[begins.size()];
        begins.push_back(out.bits());
        if (!blocks.code(stream.values.data() + std::size_t{first} * n, count, choices)) return false;
        first += count;
    }
    out.align();
    return true;
}

/// The resident stream of its parts.
Result<Words> assemble(const StoredStream& stream, const BlockBits& data, std::span<const std::uint64_t> begins,
                       std::uint64_t most_words) {
    VertexStreamParts parts;
    parts.vertices = stream.vertices;
    parts.layout = stream.choices.layout;
    parts.parameter = stream.choices.lattice;
    parts.largest_error = stream.choices.error;
    parts.components = stream.choices.components;
    parts.exceptions = stream.exceptions;
    parts.begins = begins;
    parts.data = data.finished();
    if (parts.size() > most_words) return Error{ErrorCode::memory_limit, "stored vertex stream: too large"};
    if (data.words() > UINT32_MAX) return malformed_vertices("more than its table numbers");
    for (std::size_t b = 0; b < begins.size(); ++b) {
        if ((begins[b] - begins[b / kVertexGroup * kVertexGroup]) >> parts.field_bits() == 0) continue;
        return malformed_vertices("a block is farther than its table says");
    }
    return make_vertex_stream(parts);
}

/// A walk, recorded.
class WalkRecord {
  public:
    void start(std::uint32_t v, std::uint32_t from) { steps_.push_back({v, from, kStart, {}}); }
    void predicted(std::uint32_t v, const Parallelograms& by, bool two) {
        steps_.push_back({v, kNone, two ? kTwo : kOne, by});
    }
    template <class Visitor>
    void run(Visitor& visitor) const {
        for (const Step& step : steps_) {
            if (step.kind == kStart) {
                visitor.start(step.v, step.from);
            } else {
                visitor.predicted(step.v, step.by, step.kind == kTwo);
            }
        }
    }

  private:
    enum Kind : std::uint8_t { kStart, kOne, kTwo };
    struct Step {
        std::uint32_t v, from;
        Kind kind;
        Parallelograms by;
    };
    std::vector<Step> steps_;
};

constexpr VertexRule kRules[] = {VertexRule::parallelograms, VertexRule::mean, VertexRule::neighbor, VertexRule::none};

/// Chooses how integers are predicted: by trial.
class ParameterSearch {
  public:
    /// `are_differences`: the values may need no prediction any more.
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
    /// Words that the values take by the best parameters.
    std::size_t least() const { return least_; }

  private:
    std::size_t words(const VertexParameters& parameters, std::uint32_t n, std::span<std::uint32_t> values) const {
        Encoder coder;
        with_values(coder, parameters, n, values, [&](auto& visitor) { walk_.run(visitor); });
        return coder.finish().size();
    }

    /// The best rule of each component alone.
    void find_rules() {
        Words alone(values_.size() / n_);
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
    /// Tries some values, rising, until one is worse than the one before.
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

    const WalkRecord& walk_;
    std::uint32_t n_;
    std::span<std::uint32_t> values_;
    std::span<const VertexRule> rules_;
    VertexParameters parameters_;
    std::size_t least_ = SIZE_MAX;
};

StoredStream parts_of(const VertexView& view) {
    lacedring_vertices stream;
    [[maybe_unused]] const lacedring_status status =
        lacedring_vertices_open(view.words.data(), view.words.size(), &stream, nullptr);
    assert(status == LACEDRING_STATUS_OK);
    StoredStream out;
    out.vertices = view.vertices;
    out.choices.layout = view.words[2];
    out.choices.lattice = view.words[4];
    out.choices.error = view.words[5];
    for (std::uint32_t c = 0; c < view.integers; ++c) {
        const std::uint32_t said = stream.parameters[2 * c + 1];
        out.choices.components.push_back({stream.parameters[2 * c], said & 63, said >> 6 & 31, said >> 11 & 31});
    }
    out.exceptions.assign(stream.exceptions, stream.exceptions + std::size_t{2} * view.exceptions);
    out.values.resize(std::size_t{view.vertices} * view.integers);
    if (view.vertices > 0) lacedring_vertices_blocks(&stream, 0, view.blocks(), out.values.data());
    out.blocks = read_choices(stream);
    return out;
}

/// The integers as differences from what the positions lead one to expect, two a vertex.
Words differences_of(StoredStream& stream, const WalkRecord& walk, std::span<const std::uint32_t> triangles,
                     const VertexPlaces& places) {
    Words out = stream.values;
    if (stream.is_octahedral()) {
        stream.base = nearest_base(places, triangles, stream.values, stream.bits());
        subtract_normals(out, surface_normals(places, triangles, stream.vertices, stream.base, stream.bits()),
                         stream.bits());
        return out;
    }
    struct Nothing {
        void start(std::uint32_t, std::uint32_t) {}
        void predicted(std::uint32_t, const Parallelograms&, bool) {}
    } nothing;
    const PlacePrediction prediction(places);
    PlaceVisitor<false, Nothing> visitor(prediction, stream.values, out, nothing);
    walk.run(visitor);
    return out;
}

/// Finds the parameters. Returns the integers as they are coded.
Words choose_prediction(StoredStream& stream, const WalkRecord& walk, std::span<const std::uint32_t> triangles,
                        const VertexPlaces& places) {
    const std::uint32_t n = stream.components();
    ParameterSearch plain(walk, n, stream.values, false);
    stream.parameters = plain.best();
    if (n != 2 || places.positions.empty() || !has_places(places, stream.vertices)) return stream.values;
    Words differences = differences_of(stream, walk, triangles, places);
    ParameterSearch with(walk, n, differences, true);
    const VertexParameters parameters = with.best();
    if (with.least() >= plain.least()) return stream.values;
    stream.parameters = parameters;
    stream.by_places = true;
    return differences;
}

/// Decodes the integers.
void restore_values(Decoder& coder, StoredStream& stream, std::span<const std::uint32_t> triangles,
                    const VertexPlaces& places) {
    const std::uint32_t n = stream.components();
    const bool by_map = stream.by_places && !stream.is_octahedral();
    {
        VertexWalk walk(triangles, stream.vertices);  // first: making it takes more memory than having it
        stream.values.resize(std::size_t{stream.vertices} * n);
        Words differences(by_map ? stream.values.size() : 0);
        with_values(coder, stream.parameters, n, by_map ? differences : stream.values, [&](auto& visitor) {
            if (!by_map) return walk.run(visitor);
            const PlacePrediction prediction(places);
            PlaceVisitor<true, std::remove_reference_t<decltype(visitor)>> with(prediction, stream.values, differences,
                                                                                visitor);
            walk.run(with);
        });
    }
    if (!stream.by_places || !stream.is_octahedral()) return;
    add_normals(stream.values, surface_normals(places, triangles, stream.vertices, stream.base, stream.bits()),
                stream.bits());
}

}  // namespace

std::optional<std::vector<std::uint32_t>> store_vertices(const VertexView& view,
                                                         std::span<const std::uint32_t> triangles,
                                                         const VertexPlaces& places) {
    StoredStream stream = parts_of(view);
    const std::uint32_t n = stream.components();
    WalkRecord walk;
    VertexWalk(triangles, view.vertices).run(walk);
    Words integers = choose_prediction(stream, walk, triangles, places);
    std::vector<VertexComponent> usual(n);
    find_vertex_ranges(stream.values, static_cast<VertexMapping>(stream.mapping()), usual);
    bool has_usual_ranges = true;
    for (std::uint32_t c = 0; c < n; ++c) {
        const VertexComponent& own = stream.choices.components[c];
        has_usual_ranges &= own.low == usual[c].low && own.first_bits == usual[c].first_bits;
    }
    Encoder coder;
    if (!code_header(coder, stream, has_usual_ranges)) return {};
    with_values(coder, stream.parameters, n, integers, [&](auto& visitor) { walk.run(visitor); });
    if (!code_exceptions(coder, stream)) return {};
    BlockBits bits;
    std::vector<std::uint64_t> begins;
    if (!code_blocks(coder, stream, UINT64_MAX, bits, begins)) return {};
    std::vector<std::uint32_t> out = coder.finish();
    const auto restored = restore_vertices(out, triangles, view.vertices, view.words.size(), places);
    if (!restored || !std::ranges::equal(*restored, view.words)) return {};
    return out;
}

Result<VertexView> view_stored_vertices(std::span<const std::uint32_t> stored) {
    Decoder coder(stored);
    StoredStream stream;
    bool has_usual_ranges = false;
    const Error error = malformed_vertices("its header says something impossible");
    if (coder.bad() || !code_header(coder, stream, has_usual_ranges) || coder.bad()) return error;
    const std::uint32_t n = stream.components(), type = stream.choices.layout >> 8 & 15;
    if (type > static_cast<std::uint32_t>(ComponentType::f64) || stream.mapping() > 5) return error;
    VertexView out;
    out.mapping = static_cast<VertexMapping>(stream.mapping());
    out.type = static_cast<ComponentType>(type);
    out.normalized = (stream.choices.layout >> 12 & 1) != 0;
    out.integers = static_cast<std::uint8_t>(n);
    const std::uint32_t values = out.mapping == VertexMapping::octahedral ? n + 1
                                 : out.mapping == VertexMapping::doubles  ? n / 2
                                                                          : n;
    out.components = static_cast<std::uint8_t>(values);
    out.largest_error = std::bit_cast<float>(stream.choices.error);
    return out;
}

Result<std::vector<std::uint32_t>> restore_vertices(std::span<const std::uint32_t> stored,
                                                    std::span<const std::uint32_t> triangles, std::uint32_t vertices,
                                                    std::uint64_t most_words, const VertexPlaces& places) {
    if (triangles.size() > UINT32_MAX || triangles.size() % 3 != 0) return malformed_vertices("no triangles");
    for (const std::uint32_t v : triangles) {
        if (v >= vertices) return malformed_vertices("a triangle of a vertex that it does not have");
    }
    Decoder coder(stored);
    StoredStream stream;
    stream.vertices = vertices;
    bool has_usual_ranges = false;
    if (coder.bad() || !code_header(coder, stream, has_usual_ranges) || coder.bad())
        return malformed_vertices("its header says something impossible");
    if (stream.by_places && (places.positions.empty() || !has_places(places, vertices)))
        return malformed_vertices("it is predicted by the mesh's positions, and these are no integers");
    const std::uint32_t n = stream.components();
    restore_values(coder, stream, triangles, places);
    if (coder.bad()) return malformed_vertices("its integers end early");
    if (!code_exceptions(coder, stream)) return malformed_vertices("an exception is impossible");
    if (has_usual_ranges) {
        find_vertex_ranges(stream.values, static_cast<VertexMapping>(stream.mapping()), stream.choices.components);
    } else {
        for (std::size_t i = 0; i < stream.values.size(); ++i) {
            const VertexComponent& c = stream.choices.components[i % n];
            if (static_cast<std::uint64_t>(stream.values[i] - c.low) >> c.first_bits != 0)
                return malformed_vertices("an integer is out of its range");
        }
    }
    BlockBits bits;
    std::vector<std::uint64_t> begins;
    if (!code_blocks(coder, stream, most_words, bits, begins)) {
        if (bits.words() > most_words) return Error{ErrorCode::memory_limit, "stored vertex stream: too large"};
        return malformed_vertices("a block says something impossible");
    }
    if (!coder.is_at_end()) return malformed_vertices("it does not end where its parts do");
    return assemble(stream, bits, begins, most_words);
}

}  // namespace lacedring::storage
