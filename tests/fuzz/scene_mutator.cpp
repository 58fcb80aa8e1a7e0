// Mutates the contents of packed scenes: decompresses the document, a stream, part codes or a coded view, changes it
// and compresses it again.

#include <algorithm>
#include <cstring>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "lacedring/lacedring.hpp"
#include "lrio/scene/deflate.h"
#include "lrio/scene/part_codes.h"
#include "lrio/scene/stream_decoder.h"
#include "tests/fuzz/gltf.h"
#include "tests/fuzz/targets.h"

namespace lacedring::fuzz {

extern const Target lr_file_target;

namespace {

using nlohmann::ordered_json;

constexpr const char* kName = "LACEDRING_mesh_compression";
// Limit of inflated bytes.
constexpr std::uint64_t kMost = 1 << 20;

/// The member of a value that may not be an object or array, or null.
template <class Key>
ordered_json* member(ordered_json* value, Key key) {
    if constexpr (std::is_integral_v<Key>) {
        return value != nullptr && value->is_array() && key < value->size() ? &(*value)[key] : nullptr;
    } else {
        if (value == nullptr || !value->is_object()) return nullptr;
        const auto found = value->find(key);
        return found == value->end() ? nullptr : &*found;
    }
}
ordered_json* extension_in(ordered_json* value) {
    return member(member(value, "extensions"), kName);
}
std::size_t number_in(ordered_json* value, const char* key, std::size_t otherwise = SIZE_MAX) {
    const ordered_json* found = member(value, key);
    return found != nullptr && found->is_number_unsigned() ? found->get<std::size_t>() : otherwise;
}

Bytes inflated(const Bytes& bytes) {
    const auto out = detail::inflate_bytes(bytes, kMost);
    return out ? *out : Bytes();
}
Bytes deflated(const Bytes& bytes) {
    return detail::deflate_bytes(bytes).value();
}

/// Bytes of the binary chunk, and the JSON object with their position.
struct Place {
    ordered_json* object;
    Bytes bytes;
};

/// The parts of a packed GLB.
class Scene {
  public:
    /// Empty if the bytes are not a packed GLB.
    static std::optional<Scene> open(const Bytes& glb) {
        const GlbChunks chunks = split_glb(glb);
        Scene out;
        out.outer_ = parse(chunks.json);
        out.bin_ = chunks.bin;
        if (const ordered_json* view = member(extension_in(&out.outer_), "document")) {
            out.packed_view_ = view->is_number_unsigned() ? view->get<std::size_t>() : SIZE_MAX;
            const auto bytes = out.bytes_of(member(member(&out.outer_, "bufferViews"), *out.packed_view_));
            if (!bytes) return {};
            out.inner_ = parse(inflated(*bytes));
        }
        if (!out.document().is_object()) return {};
        return out;
    }

    void mutate(std::size_t max_size, Random& random) {
        find_places();
        const std::uint32_t what = random_below(random, places_.empty() ? 2 : 8);
        if (what >= 2) mutate_place(places_[random_below(random, places_.size())], max_size, random);
        lay_out();
        if (what == 0) mutate_text(max_size);
        if (what == 1) mutate_number(document(), random);
    }

    Bytes glb() {
        Bytes bin = bin_;
        std::string text = text_ ? *text_ : dump(document());
        if (packed_view_) {
            ordered_json* view = member(member(&outer_, "bufferViews"), *packed_view_);
            const auto from = std::as_bytes(std::span(text));
            const Bytes packed = deflated({from.begin(), from.end()});
            bin.resize((bin.size() + 3) / 4 * 4);
            (*view)["byteOffset"] = bin.size();
            (*view)["byteLength"] = packed.size();
            bin.insert(bin.end(), packed.begin(), packed.end());
            ordered_json* outer_buffer = member(member(&outer_, "buffers"), std::size_t{0});
            if (outer_buffer != nullptr && outer_buffer->is_object()) (*outer_buffer)["byteLength"] = bin.size();
            text = dump(outer_);
        }
        const auto json = std::as_bytes(std::span(text));
        return join_glb({{json.begin(), json.end()}, bin});
    }

  private:
    static ordered_json parse(const Bytes& text) {
        return ordered_json::parse(reinterpret_cast<const char*>(text.data()),
                                   reinterpret_cast<const char*>(text.data() + text.size()), nullptr, false);
    }
    static std::string dump(const ordered_json& value) {
        return value.dump(-1, ' ', false, ordered_json::error_handler_t::replace);
    }

    ordered_json& document() { return packed_view_ ? inner_ : outer_; }

    std::optional<Bytes> bytes_of(ordered_json* place) {
        const std::size_t at = number_in(place, "byteOffset", 0), size = number_in(place, "byteLength");
        if (number_in(place, "buffer") != 0 || at > bin_.size() || size > bin_.size() - at) return {};
        const auto from = bin_.begin() + static_cast<std::ptrdiff_t>(at);
        return Bytes(from, from + static_cast<std::ptrdiff_t>(size));
    }

    /// Finds everything in the binary chunk that the document refers to.
    void find_places() {
        ordered_json* views = member(&document(), "bufferViews");
        for (std::size_t i = 0; views != nullptr && i < views->size(); ++i) {
            ordered_json* view = member(views, i);
            ordered_json* coded = extension_in(view);
            ordered_json* place = coded != nullptr ? coded : view;
            if (auto bytes = bytes_of(place)) places_.push_back({place, std::move(*bytes)});
        }
    }

    /// Rewrites the binary chunk.
    void lay_out() {
        if (places_.empty()) return;
        bin_.clear();
        for (const Place& place : places_) {
            bin_.resize((bin_.size() + 7) / 8 * 8);
            (*place.object)["byteOffset"] = bin_.size();
            (*place.object)["byteLength"] = place.bytes.size();
            bin_.insert(bin_.end(), place.bytes.begin(), place.bytes.end());
        }
        places_.clear();
        ordered_json* buffer = member(member(&document(), "buffers"), std::size_t{0});
        if (buffer != nullptr && buffer->is_object()) (*buffer)["byteLength"] = bin_.size();
    }

    void mutate_text(std::size_t max_size) {
        const std::string text = dump(document());
        const auto from = std::as_bytes(std::span(text));
        Bytes bytes(from.begin(), from.end());
        mutate_bytes(bytes, packed_view_ ? std::min<std::size_t>(4 * max_size, kMost) : max_size);
        text_ = std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    }

    /// Changes a random number within the value, removes a member, or repeats an element.
    static void mutate_number(ordered_json& value, Random& random) {
        ordered_json* at = &value;
        while (at->is_structured() && !at->empty()) {
            const auto chosen = std::next(at->begin(), random_below(random, at->size()));
            if (random_below(random, 40) == 0) {
                at->erase(chosen);
                return;
            }
            if (at->is_array() && random_below(random, 40) == 0) {
                at->push_back(ordered_json(*chosen));
                return;
            }
            at = &*chosen;
        }
        if (at->is_boolean()) *at = !at->get<bool>();
        if (!at->is_number_unsigned()) return;
        const auto number = at->get<std::uint64_t>();
        const std::uint64_t others[] = {number + 1,
                                        number - 1,
                                        number ^ 1U << random_below(random, 8),
                                        0,
                                        number * 2,
                                        UINT32_MAX,
                                        random_below(random, 16)};
        *at = others[random_below(random, std::size(others))];
    }

    void mutate_place(Place& place, std::size_t max_size, Random& random) {
        if (random_below(random, 16) == 0) return mutate_bytes(place.bytes, place.bytes.size() + 16);
        const ordered_json* coding = member(place.object, "coding");
        if (coding != nullptr && *coding == "floats") return mutate_floats(place.bytes, random);
        if (coding != nullptr) return mutate_packed(place.bytes);
        ordered_json* streams = member(extension_in(&document()), "streams");
        for (std::size_t s = 0; streams != nullptr && s < streams->size(); ++s) {
            ordered_json* stream = member(streams, s);
            Place* file = place_of(stream, "bufferView");
            Place* parts = place_of(stream, "parts");
            if (&place == parts) return mutate_packed(place.bytes);
            if (&place != file) continue;
            lr_file_target.mutate(place.bytes, max_size / 2, random);
            if (random_below(random, 8) != 0) mend(s, *file, parts);
            return;
        }
        const std::size_t size = place.bytes.size();
        mutate_bytes(place.bytes, size + 16);
        if (random_below(random, 4) != 0) place.bytes.resize(size);
    }

    Place* place_of(ordered_json* stream, const char* key) {
        const ordered_json* view = member(member(&document(), "bufferViews"), number_in(stream, key));
        const auto found = std::ranges::find(places_, view, &Place::object);
        return view == nullptr || found == places_.end() ? nullptr : &*found;
    }

    /// Mutates inflated bytes, mostly keeping their size.
    static void mutate_packed(Bytes& bytes) {
        Bytes contents = inflated(bytes);
        mutate_bytes(contents, contents.size() + 16);
        bytes = deflated(contents);
    }

    static void mutate_floats(Bytes& bytes, Random& random) {
        constexpr std::size_t head = 8;
        std::uint32_t size = 0;
        if (bytes.size() < head) return mutate_bytes(bytes, head);
        std::memcpy(&size, bytes.data() + 4, 4);
        const auto begin = bytes.begin() + head, end = begin + std::min<std::ptrdiff_t>(size, bytes.end() - begin);
        Bytes lengths = inflated({begin, end}), tail(end, bytes.end());
        if (random_below(random, 2) == 0) {
            const std::size_t count = lengths.size();
            mutate_bytes(lengths, count);
            lengths.resize(count);
            for (std::byte& length : lengths) length &= std::byte{31};
            tail.resize(tail.size() + count);  // trailing bits are refused after everything is decoded
        } else {
            const std::size_t count = tail.size();
            mutate_bytes(tail, count);
            tail.resize(count);
        }
        const Bytes packed = deflated(lengths);
        size = static_cast<std::uint32_t>(packed.size());
        std::memcpy(bytes.data() + 4, &size, 4);
        bytes.resize(head);
        bytes.insert(bytes.end(), packed.begin(), packed.end());
        bytes.insert(bytes.end(), tail.begin(), tail.end());
    }

    /// Finds the stream's parts in the primitives of the document: their sets and index accessors.
    std::vector<std::size_t> find_parts(std::size_t stream, ordered_json* sets,
                                        std::vector<std::uint32_t>& set_of_part) {
        std::vector<std::size_t> indices;
        ordered_json* meshes = member(&document(), "meshes");
        for (std::size_t m = 0; meshes != nullptr && m < meshes->size(); ++m) {
            ordered_json* primitives = member(member(meshes, m), "primitives");
            for (std::size_t p = 0; primitives != nullptr && p < primitives->size(); ++p) {
                ordered_json* primitive = member(primitives, p);
                const std::size_t part = number_in(extension_in(primitive), "part");
                if (number_in(extension_in(primitive), "stream") != stream || part > 64) continue;
                if (part >= indices.size()) indices.resize(part + 1, SIZE_MAX);
                set_of_part.resize(indices.size(), 0);
                indices[part] = number_in(primitive, "indices");
                const std::size_t position = number_in(member(primitive, "attributes"), "POSITION");
                for (std::size_t s = 0; s < sets->size(); ++s) {
                    const ordered_json* first = member(member(sets, s), std::size_t{0});
                    if (first != nullptr && *first == position) set_of_part[part] = static_cast<std::uint32_t>(s);
                }
            }
        }
        return indices;
    }

    /// Makes as many part codes as the stream's file has triangles, and sets the counts of accessors.
    void mend(std::size_t number, const Place& file, Place* parts) {
        ordered_json* sets = member(member(member(extension_in(&document()), "streams"), number), "sets");
        const Result<LrFile> read = parse_lr(file.bytes);
        if (sets == nullptr || !sets->is_array() || sets->empty() || !read || read->input_triangles > 4096) return;
        detail::StreamDecoder::Said said{{}, std::vector<std::uint32_t>(sets->size(), UINT32_MAX)};
        const std::vector<std::size_t> indices = find_parts(number, sets, said.set_of_part);
        if (indices.empty()) return;
        const Result<StreamView> surface = validate(read->words);
        if (parts != nullptr && surface && surface->triangles() > 0) {
            Result<std::vector<std::uint32_t>> codes = Error{};
            for (std::size_t before = 1; !codes && before < 1024; ++before) {
                codes = detail::decode_part_codes(parts->bytes, before, indices.size());
            }
            if (!codes) return;
            codes->resize(surface->triangles(), codes->back());
            if (auto made = detail::encode_part_codes(*codes)) parts->bytes = std::move(*made);
        }
        const auto decoder = detail::StreamDecoder::open(file.bytes, parts == nullptr ? Bytes() : parts->bytes, said);
        if (!decoder) return;
        const auto put = [&](std::size_t accessor, std::size_t count) {
            ordered_json* at = member(member(&document(), "accessors"), accessor);
            if (at != nullptr && at->is_object()) (*at)["count"] = count;
        };
        for (std::size_t s = 0; s < sets->size(); ++s) {
            ordered_json* set = member(sets, s);
            for (std::size_t a = 0; set->is_array() && a < set->size(); ++a) {
                if ((*set)[a].is_number_unsigned()) put((*set)[a].get<std::size_t>(), decoder->vertices(s));
            }
        }
        for (std::size_t p = 0; p < indices.size(); ++p) put(indices[p], decoder->corners(p));
    }

    ordered_json outer_, inner_;
    std::optional<std::size_t> packed_view_;
    std::optional<std::string> text_;  ///< the document as text, which may be invalid JSON
    std::vector<Place> places_;
    Bytes bin_;
};

}  // namespace

void mutate_scene(Bytes& bytes, std::size_t max_size, Random& random) {
    if (random_below(random, 8) == 0) return mutate_gltf(bytes, max_size, random);
    std::optional<Scene> scene = Scene::open(bytes);
    if (!scene) return mutate_gltf(bytes, max_size, random);
    scene->mutate(max_size, random);
    Bytes out = scene->glb();
    if (out.size() <= max_size) bytes = std::move(out);
}

}  // namespace lacedring::fuzz
