// The target for .lr files: mutates sections, writes them again with valid offsets and checksums (docs/lr-file.md).

#include "lacedring/lr_file.hpp"

#include <algorithm>
#include <cstring>
#include <utility>

#include "lacedring/lacedring.hpp"
#include "lacedring/seams.hpp"
#include "lrcore/base/crc32.h"
#include "tests/fuzz/streams.h"
#include "tests/fuzz/use.h"

namespace lacedring::fuzz {
namespace {

struct Header {
    std::uint32_t magic, version, sections, vertices, input_triangles, copies, table_crc, header_crc;
};
struct Entry {
    std::uint16_t kind, coding;
    std::uint32_t crc;
    std::uint64_t offset, size;
    std::uint32_t layout, name_length;
};
struct Section {
    Entry entry;
    Bytes contents;
};
constexpr std::uint32_t kAttribute = 2, kVertexOrder = 3, kCornerOrder = 4, kVertices = 8, kSeams = 9,
                        kPerCopy = 1U << 18;

/// The format of a section's kind; lean for kinds that are not streams.
Format format_of(std::uint32_t kind) {
    return kind == 5 ? Format::lr : kind == 6 ? Format::lr_compact : kind == 7 ? Format::packed : Format::lean;
}

/// True if both attributes are equal byte by byte, vertex streams included.
template <class Other>
bool same_attribute(const Other& a, const LrAttribute& b) {
    return a.name == b.name && a.type == b.type && a.components == b.components && a.normalized == b.normalized &&
           a.v_up == b.v_up && a.per_copy == b.per_copy && std::ranges::equal(a.data, b.data) &&
           std::ranges::equal(a.words, b.words);
}

/// Checks that the surface of a mesh with seams is the one that the connectivity decodes to, and encodes the mesh
/// again.
void check_seams(const LrFile& file, const Mesh& mesh, const Surface& surface) {
    const StreamView stream = view_stream(file.words).value();
    const std::vector<std::uint32_t> slots = slot_triangles(stream);
    use_seams(view_seams(file.seams, stream.slots(), stream.vertices()).value(), slots);
    LrFile whole = file;
    whole.seams.clear();
    whole.copy_count = 0;
    whole.vertex_order.clear();
    std::erase_if(whole.attributes, [](const LrAttribute& attribute) { return attribute.per_copy; });
    const Mesh plain = decode_lr(whole).value(), joined = surface_mesh(mesh, surface);
    REQUIRE(plain.indices.size() == joined.indices.size());
    std::vector<std::uint32_t> there(joined.vertex_count, UINT32_MAX), back(plain.vertex_count, UINT32_MAX);
    for (std::size_t i = 0; i < plain.indices.size(); ++i) {
        const std::uint32_t v = joined.indices[i], w = plain.indices[i];
        if (there[v] == UINT32_MAX) there[v] = w;
        if (back[w] == UINT32_MAX) back[w] = v;
        REQUIRE(there[v] == w && back[w] == v);
        const std::size_t stride = plain.attributes[0].stride();
        REQUIRE(std::memcmp(plain.attributes[0].data.data() + w * stride, joined.attributes[0].data.data() + v * stride,
                            stride) == 0);
    }
    if (mesh.triangle_count() == 0 || mesh.triangle_count() > 300 || mesh.vertex_count > 2000) return;
    Result<Encoded> encoded = encode(joined.indices, joined.vertex_count, {.format = file.format, .effort = 0});
    REQUIRE(encoded);
    const Result<LrFile> made = make_lr_file(mesh, surface, std::move(*encoded), true);
    REQUIRE(made);
    const Result<LrFile> read = parse_lr(serialize_lr(*made));
    REQUIRE(read);
    const Mesh original = decode_lr_original_order(*read).value();
    REQUIRE(original.indices == mesh.indices && same_attributes(original, mesh));
}

// Larger files in storage form are slow.
constexpr std::uint64_t kMostStored = 64 << 20;

bool run(std::span<const std::byte> bytes) {
    // view_lr_file needs an aligned address; memory of operator new is aligned.
    Result<LrFileView> in_place = view_lr_file(bytes);
    const Result<LrFile> file = parse_lr(bytes, kMostStored);
    const Result<LrContents> listed = list_lr(bytes);
    if (!in_place) check_message(in_place.error());
    if (!listed) check_message(listed.error());
    if (!file) {
        check_message(file.error());
        return false;
    }
    const Bytes resident = serialize_lr(*file);
    if (listed && std::ranges::any_of(listed->sections, &LrSection::stored)) {
        REQUIRE(!in_place && in_place.error().code == ErrorCode::unsupported);
        in_place = view_lr_file(resident);
    }
    REQUIRE(listed && in_place && in_place->format == file->format);
    REQUIRE(std::ranges::equal(in_place->words, file->words));
    REQUIRE(std::ranges::equal(in_place->attributes, file->attributes, same_attribute<AttributeView>));
    for (const LrAttribute& attribute : file->attributes) {
        REQUIRE(attribute.words.empty() || use_vertex_stream(attribute.words));
    }
    const std::optional<Words> indices = use_stream(file->format, file->words);
    REQUIRE(indices);
    REQUIRE(indices->size() / 3 <= file->input_triangles);
    REQUIRE(in_place->validate() && in_place->copy_count == file->copy_count);
    REQUIRE(std::ranges::equal(in_place->seams, file->seams));
    Surface surface;
    const Mesh mesh = decode_lr(*file, &surface).value();
    REQUIRE(mesh.indices.size() == indices->size());
    if (file->seams.empty()) {
        REQUIRE(!surface.has_seams() && surface.vertex_count == mesh.vertex_count);
    } else {
        check_seams(*file, mesh, surface);
    }
    if (!mesh.indices.empty()) check_mesh(mesh);
    const bool ordered = !file->vertex_order.empty() && !file->corner_order.empty();
    const Result<Mesh> original = decode_lr_original_order(*file);
    if (!original) check_message(original.error());
    REQUIRE(!ordered || original);
    if (original && !mesh.indices.empty()) {
        check_mesh(*original);
        REQUIRE(original->vertex_count == mesh.vertex_count && original->indices.size() == mesh.indices.size());
    }
    for (const LrForm form : {LrForm::resident, LrForm::stored}) {
        const Result<LrFile> again = parse_lr(serialize_lr(*file, form));
        REQUIRE(again && again->words == file->words && again->vertex_order == file->vertex_order &&
                again->corner_order == file->corner_order && again->seams == file->seams);
        REQUIRE(std::ranges::equal(again->attributes, file->attributes, same_attribute<LrAttribute>));
    }
    LrFile compressed = *file;
    REQUIRE(compress_attributes(compressed));
    REQUIRE(same_attributes(decode_lr(compressed).value(), mesh));
    return true;
}

/// The header and the sections, cut at the end of the bytes.
std::vector<Section> take_apart(const Bytes& bytes, Header& header) {
    std::vector<Section> out;
    std::memcpy(&header, bytes.data(), sizeof header);
    for (std::size_t at = sizeof header; out.size() < header.sections; at += sizeof(Entry)) {
        Section section;
        if (at + sizeof section.entry > bytes.size()) break;
        std::memcpy(&section.entry, bytes.data() + at, sizeof section.entry);
        const std::uint64_t begin = std::min<std::uint64_t>(section.entry.offset, bytes.size());
        const std::uint64_t size = std::min<std::uint64_t>(section.entry.size, bytes.size() - begin);
        const auto from = bytes.begin() + static_cast<std::ptrdiff_t>(begin);
        section.contents.assign(from, from + static_cast<std::ptrdiff_t>(size));
        out.push_back(std::move(section));
    }
    return out;
}

Bytes put_together(Header header, std::vector<Section>& sections) {
    header.sections = static_cast<std::uint32_t>(sections.size());
    Bytes out(sizeof header + sections.size() * sizeof(Entry));
    for (Section& section : sections) {
        out.resize((out.size() + 7) / 8 * 8);
        section.entry.offset = out.size();
        section.entry.size = section.contents.size();
        section.entry.crc = crc32(section.contents);
        out.insert(out.end(), section.contents.begin(), section.contents.end());
    }
    for (std::size_t i = 0; i < sections.size(); ++i) {
        std::memcpy(out.data() + sizeof header + i * sizeof(Entry), &sections[i].entry, sizeof(Entry));
    }
    header.table_crc = crc32(std::span(out).subspan(sizeof header, sections.size() * sizeof(Entry)));
    header.header_crc = crc32(std::as_bytes(std::span(&header, 1)).first(28));
    std::memcpy(out.data(), &header, sizeof header);
    return out;
}

template <class T>
void mutate_number(T& number, Random& random) {
    number = static_cast<T>(random_below(random, 2) == 0 ? number + random_below(random, 5) - 2
                                                         : number ^ 1U << random_below(random, 8 * sizeof(T)));
}

void mutate_section(Section& section, std::size_t room, Random& random) {
    Bytes& contents = section.contents;
    const std::size_t most = contents.size() + room;
    if (section.entry.coding != 0) return mutate_bytes(contents, most);
    switch (section.entry.kind) {
        case kAttribute: {
            const std::size_t size = contents.size();
            mutate_bytes(contents, most);
            if (random_below(random, 4) != 0) contents.resize(size);
            return;
        }
        case kVertexOrder:
        case kCornerOrder:
            if (contents.size() >= 8 && random_below(random, 2) == 0) {  // keeps it a permutation
                const auto word = [&] {
                    return contents.begin() + std::ptrdiff_t{4} * random_below(random, contents.size() / 4);
                };
                const auto a = word();
                std::swap_ranges(a, a + 4, word());
                return;
            }
            mutate_bytes(contents, most);
            return;
        default: {
            const bool vertices = section.entry.kind == kVertices;
            const std::size_t name = vertices ? (std::size_t{section.entry.name_length} + 7) / 8 * 8 : 0;
            if (name > contents.size() || (vertices && random_below(random, 16) == 0)) {
                return mutate_bytes(contents, most);
            }
            Words words = words_of(std::span(contents).subspan(name));
            if (vertices) {
                mutate_vertex_stream(words, (most - name) / 4, random);
            } else {
                mutate_stream(format_of(section.entry.kind), words, most / 4, random);
            }
            const auto bytes = std::as_bytes(std::span(words));
            contents.resize(name);
            contents.insert(contents.end(), bytes.begin(), bytes.end());
        }
    }
}

/// Mutates the section of seams, and resizes attributes and vertex order to its number of copies. False if the file has
/// no seams that fit its connectivity.
bool mutate_seams_of(Header& header, std::vector<Section>& sections, Random& random) {
    const auto found = std::ranges::find(sections, kSeams, [](const Section& s) { return s.entry.kind; });
    const auto words_at = [](const Section& s) { return words_of(s.contents); };
    if (found == sections.end()) return false;
    for (const Section& section : sections) {
        const std::uint32_t kind = section.entry.kind;
        if (kind != 1 && (kind < 5 || kind > 7)) continue;
        const Words connectivity = words_at(section);
        const Result<StreamView> stream = validate(connectivity);
        if (!stream) return false;
        Words seams = words_at(*found);
        mutate_seams(seams, slot_triangles(*stream), stream->vertices(), random);
        const auto bytes = std::as_bytes(std::span(seams));
        found->contents.assign(bytes.begin(), bytes.end());
        const Result<SeamView> view = view_seams(seams, stream->slots(), stream->vertices());
        if (!view || header.copies == 0 || view->copies > 4 * header.copies) return true;
        const std::uint32_t before = std::exchange(header.copies, view->copies);
        for (Section& other : sections) {
            const bool raw = other.entry.kind == kAttribute && (other.entry.layout & kPerCopy) != 0;
            const std::size_t name = raw ? (std::size_t{other.entry.name_length} + 7) / 8 * 8 : 0;
            if (name > other.contents.size()) continue;
            if (raw) other.contents.resize(name + (other.contents.size() - name) / before * header.copies);
            if (other.entry.kind != kVertexOrder) continue;
            Words order = words_at(other);
            std::erase_if(order, [&](std::uint32_t v) { return v >= header.copies; });
            while (order.size() < header.copies) order.push_back(static_cast<std::uint32_t>(order.size()));
            const auto entries = std::as_bytes(std::span(order));
            other.contents.assign(entries.begin(), entries.end());
        }
        return true;
    }
    return false;
}

void mutate(Bytes& bytes, std::size_t max_size, Random& random) {
    if (bytes.size() < sizeof(Header) || random_below(random, 8) == 0) return mutate_bytes(bytes, max_size);
    Header header;
    std::vector<Section> sections = take_apart(bytes, header);
    if (sections.empty()) return mutate_bytes(bytes, max_size);
    const std::size_t room = max_size > bytes.size() + 64 ? max_size - bytes.size() - 64 : 0;
    const std::uint32_t chosen = random_below(random, sections.size());
    Section& section = sections[chosen];
    if (random_below(random, 4) == 0 && mutate_seams_of(header, sections, random)) {
        bytes = put_together(header, sections);
        return;
    }
    switch (random_below(random, 16)) {
        case 0:
            mutate_number(random_below(random, 3) == 0   ? header.vertices
                          : random_below(random, 2) == 0 ? header.copies
                                                         : header.input_triangles,
                          random);
            break;
        case 1:
            mutate_number(section.entry.layout, random);
            break;
        case 2:
            mutate_number(section.entry.name_length, random);
            break;
        case 3:
            mutate_number(random_below(random, 4) == 0 ? section.entry.coding : section.entry.kind, random);
            break;
        case 4:
            std::swap(section, sections[random_below(random, sections.size())]);
            break;
        case 5:
            sections.erase(sections.begin() + chosen);
            break;
        case 6:
            if (section.contents.size() + 64 <= room) sections.push_back(Section(section));
            break;
        default:
            mutate_section(section, room, random);
    }
    bytes = put_together(header, sections);
}

}  // namespace

extern const Target lr_file_target{"lr_file", run, mutate};

}  // namespace lacedring::fuzz
