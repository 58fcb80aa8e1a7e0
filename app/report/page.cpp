#include "app/report/page.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "app/report/charts.h"
#include "app/report/html.h"
#include "app/report/style.h"

namespace lacedring::app {
namespace {

/// Nothing is fetched and nothing runs, whatever a file is called.
constexpr std::string_view kPolicy = "default-src 'none'; img-src data:; style-src 'unsafe-inline'";

/// How the page calls a mesh: its file without folders, or with them where two would be called the same.
std::string title_of(const MeshReport& mesh, std::span<const MeshReport> meshes) {
    const auto file = [](const MeshReport& m) { return std::filesystem::path(m.path).filename().string(); };
    const std::string out = file(mesh);
    const bool unique = std::ranges::count_if(meshes, [&](const MeshReport& m) { return file(m) == out; }) == 1;
    return unique && !out.empty() ? out : mesh.path;
}

std::string fact(const std::string& text) {
    return "<li>" + text + "</li>";
}

std::string topology(const MeshReport& mesh) {
    const TopologyReport& r = mesh.report;
    const Topology& t = mesh.topology;
    std::string out = "<ul class=\"facts topology\" aria-label=\"Topology\">";
    out += fact(counted(mesh.triangles, "triangle", "triangles"));
    out += fact(counted(mesh.vertices, "vertex", "vertices"));
    if (mesh.copies > mesh.vertices) out += fact(counted(mesh.copies, "vertex copy", "vertex copies"));
    out += fact(counted(r.components, "component", "components"));
    out += fact(t.border_edges == 0 ? "no border"
                                    : counted(t.border_edges, "border edge", "border edges") + " in " +
                                          counted(r.border_loops, "loop", "loops"));
    out += fact(r.orientable ? fmt::format("genus {}", r.genus) : "not orientable");
    if (t.nonmanifold_edges > 0) {
        out += fact(counted(t.nonmanifold_edges, "non-manifold edge", "non-manifold edges"));
    }
    if (r.nonmanifold_vertices > 0) {
        out += fact(counted(r.nonmanifold_vertices, "non-manifold vertex", "non-manifold vertices"));
    }
    if (t.degenerate > 0)
        out += fact(counted(t.degenerate, "degenerate triangle", "degenerate triangles") + " dropped");
    if (t.flipped > 0) out += fact(counted(t.flipped, "triangle", "triangles") + " flipped to orient the mesh");
    out += fact(fmt::format("{}\u00A0% of vertices have six edges", fixed(r.valence6_percent, 1)));
    return out + "</ul>\n";
}

std::string ring_line(const MeshReport& mesh) {
    const auto share = [&](std::uint32_t n) { return fixed(100.0 * n / static_cast<double>(mesh.triangles), 2); };
    const FormatFigures* lean = mesh.find("lean");
    return fmt::format(
        "<p class=\"note ringline\">Ring of lean ({}): {} on it, {} isolated; T0 {}\u00A0%, in warts {}\u00A0%, T2 "
        "{}\u00A0% of the "
        "triangles. T0, T1 and T2 have none, one and two edges on the ring; a wart is a T0 next to a T2.</p>\n",
        lean == nullptr ? "" : lean->ring, counted(mesh.lean.ring_vertices, "vertex", "vertices"),
        grouped(mesh.lean.isolated), share(mesh.lean.t0), share(mesh.lean.t0_wart), share(mesh.lean.t2));
}

std::string pictures(const MeshReport& mesh, const std::string& title) {
    if (mesh.pictures.empty()) {
        return fmt::format("<p class=\"note nopictures\">No pictures: {}.</p>\n", escape_html(mesh.no_pictures));
    }
    struct Text {
        std::string_view view;
        const char *title, *alt, *caption;
    };
    static constexpr Text kTexts[] = {
        {"smooth", "The mesh", "the mesh, smoothly shaded", "Interpolated normals."},
        {"class", "The ring and its triangles",
         "triangles colored by what they are to the ring, the ring as a black line",
         "The ring (black) and the triangles: "
         "<span class=\"legend\"><span class=\"swatch\" style=\"background:#ead8ae\"></span>T1 left,</span> "
         "<span class=\"legend\"><span class=\"swatch\" style=\"background:#d97c28\"></span>T1 right,</span> "
         "<span class=\"legend\"><span class=\"swatch\" style=\"background:#4d9a4a\"></span>T0,</span> "
         "<span class=\"legend\"><span class=\"swatch\" style=\"background:#35609f\"></span>T2,</span> "
         "<span class=\"legend\"><span class=\"swatch\" style=\"background:#b02530\"></span>a wart’s T0,</span> "
         "<span class=\"legend\"><span class=\"swatch\" style=\"background:#7c7c7c\"></span>its T2.</span>"},
        {"ring", "Order along the ring", "vertices colored by their place along the ring, the ring as a black line",
         "Vertices by their place: <span class=\"legend\">first <span class=\"ramp\"></span> last;</span> "
         "<span class=\"legend\">gray: on no ring.</span>"},
    };
    std::string out = "<div class=\"pictures\">\n";
    for (const ReportPicture& picture : mesh.pictures) {
        const auto* text = std::ranges::find(kTexts, picture.view, &Text::view);
        if (text == std::end(kTexts)) continue;
        out += fmt::format(
            "<figure><img src=\"{}\" width=\"{}\" height=\"{}\" alt=\"{}: {}\">"
            "<figcaption><b>{}</b> {}</figcaption></figure>\n",
            picture.uri, picture.width, picture.height, escape_html(title), text->alt, text->title, text->caption);
    }
    return out + "</div>\n";
}

std::string table_of_sizes(const MeshReport& mesh, const std::string& title) {
    std::string out = fmt::format(
        "<h3>Sizes</h3>\n<div class=\"wide\" role=\"region\" aria-label=\"Sizes of {}\" tabindex=\"0\">"
        "<table class=\"sizes\"><thead><tr><th scope=\"col\" class=\"left\">format</th>"
        "<th scope=\"col\">bits per<br>triangle</th><th scope=\"col\">bytes</th>"
        "<th scope=\"col\">references<br>per triangle</th><th scope=\"col\">of<br>index_u32</th>"
        "<th scope=\"col\">ACMR<br>FIFO 32</th><th scope=\"col\">ATVR<br>FIFO 32</th>"
        "<th scope=\"col\">bytes<br>deflated</th><th scope=\"col\" class=\"left\">ring</th>"
        "<th scope=\"col\" class=\"left\">what it is</th></tr></thead>\n<tbody>\n",
        escape_html(title));
    for (const FormatFigures& f : mesh.formats) {
        const FormatNote note = note_on(f.name);
        out += fmt::format(
            "<tr class=\"{}\"><th scope=\"row\">{}</th><td class=\"strong\">{}</td><td>{}</td><td>{}</td>"
            "<td>{}</td><td>{}</td><td>{}</td><td>{}</td><td class=\"left\">{}</td>"
            "<td class=\"left what\">{}{}</td></tr>\n",
            class_of(note.origin), escape_html(f.name), fixed(f.bits, 3), grouped(f.bytes),
            f.references == 0 ? "" : fixed(f.references, 3),
            std::isfinite(f.share) ? fixed(f.share, 1) + "\u00A0%" : "", fixed(f.cache.acmr, 3), fixed(f.cache.atvr, 3),
            f.deflated == 0 ? "" : grouped(f.deflated), f.ring,
            note.origin == Origin::baseline ? "<span class=\"tag\">baseline</span> " : "", note.what);
    }
    for (const auto& [name, reason] : mesh.absent) {
        out += fmt::format(
            "<tr class=\"{} absent\"><th scope=\"row\">{}</th><td class=\"left\" colspan=\"9\">absent: {}</td></tr>\n",
            class_of(note_on(name).origin), escape_html(name), escape_html(reason));
    }
    return out +
           fmt::format(
               "</tbody></table></div>\n<p class=\"note\">Connectivity alone, headers included; per triangle of the "
               "input. ACMR and ATVR: vertices transformed per triangle and per vertex, in the format’s order, "
               "with a FIFO cache of 32.{} "
               "Deflated: where the format is for transmission. Ring: how it was grown, and passes of the "
               "optimizer.</p>\n",
               mesh.best_order ? fmt::format(" meshoptimizer’s best order for the vertex cache: ACMR {}, ATVR {}.",
                                             fixed(mesh.best_order->acmr, 3), fixed(mesh.best_order->atvr, 3))
                               : "");
}

/// "meshopt_index_codec", with places to break it.
std::string breakable(std::string_view name) {
    std::string out;
    for (const char c : name) c == '_' ? out += "_<wbr>" : out += c;
    return out;
}

double median(std::vector<double> values) {
    std::erase_if(values, [](double v) { return !std::isfinite(v); });
    if (values.empty()) return NAN;
    std::ranges::sort(values);
    return (values[(values.size() - 1) / 2] + values[values.size() / 2]) / 2;
}

/// A row a mesh, and the median below.
std::string overview(std::span<const MeshReport> meshes) {
    constexpr std::string_view kColumns[] = {
        "index_u32", "strip_restart", "meshopt_index_codec", "packed", "packed_cache", "lean", "lr", "lr_compact"};
    std::string head, rows;
    for (const std::string_view name : kColumns) head += fmt::format("<th scope=\"col\">{}</th>", breakable(name));
    for (std::size_t i = 0; i < meshes.size(); ++i) {
        rows += fmt::format(
            "<tr><th scope=\"row\" class=\"name\"><a href=\"#mesh-{}\">{}</a></th><td>{}</td><td>{}</td>", i + 1,
            name_html(title_of(meshes[i], meshes)), grouped(meshes[i].triangles), grouped(meshes[i].report.components));
        for (const std::string_view name : kColumns) {
            const FormatFigures* format = meshes[i].find(name);
            rows += fmt::format("<td>{}</td>", format == nullptr ? "absent" : fixed(format->bits, 2));
        }
        const FormatFigures* cache = meshes[i].find("packed_cache");
        rows += fmt::format("<td>{}</td><td>{}</td></tr>\n", cache == nullptr ? "" : fixed(cache->cache.acmr, 3),
                            meshes[i].best_order ? fixed(meshes[i].best_order->acmr, 3) : "absent");
    }
    rows += "<tr class=\"sum\"><th scope=\"row\">median</th><td></td><td></td>";
    const auto add_median = [&](auto value, int decimals) {
        std::vector<double> values;
        for (const MeshReport& mesh : meshes) values.push_back(value(mesh));
        rows += fmt::format("<td>{}</td>", fixed(median(std::move(values)), decimals));
    };
    for (const std::string_view name : kColumns) {
        add_median([&](const MeshReport& mesh) { return mesh.find(name) == nullptr ? NAN : mesh.find(name)->bits; }, 2);
    }
    add_median(
        [](const MeshReport& mesh) {
            const FormatFigures* cache = mesh.find("packed_cache");
            return cache == nullptr ? NAN : cache->cache.acmr;
        },
        3);
    add_median([](const MeshReport& mesh) { return mesh.best_order ? mesh.best_order->acmr : NAN; }, 3);
    rows += "</tr>\n";
    return fmt::format(
        "<section aria-labelledby=\"overview\"><h2 id=\"overview\">Overview</h2>\n"
        "<div class=\"wide\" role=\"region\" aria-label=\"Overview\" tabindex=\"0\"><table class=\"overview\"><thead>"
        "<tr><td></td><td></td><td></td><th scope=\"colgroup\" colspan=\"{}\">bits per triangle</th>"
        "<th scope=\"colgroup\" colspan=\"2\">ACMR, FIFO 32</th></tr>\n"
        "<tr><th scope=\"col\" class=\"left\">mesh</th><th scope=\"col\">triangles</th><th "
        "scope=\"col\">components</th>{}"
        "<th scope=\"col\">packed_<wbr>cache</th><th scope=\"col\">best<br>order</th></tr></thead>\n<tbody>\n{}"
        "</tbody></table></div></section>\n",
        std::size(kColumns), head, rows);
}

std::string section(const MeshReport& mesh, std::size_t number, const ReportPage& page, const BitScale& scale) {
    const std::string title = title_of(mesh, page.meshes);
    std::string out = fmt::format("<section aria-labelledby=\"mesh-{}\"><h2 id=\"mesh-{}\">{}</h2>\n", number, number,
                                  name_html(title));
    if (title != mesh.path) out += fmt::format("<p class=\"path\"><code>{}</code></p>\n", name_html(mesh.path));
    out += topology(mesh) + ring_line(mesh);
    out += pictures(mesh, title);
    out += "<h3>Bits per triangle</h3>\n" + bit_bars(mesh, scale);
    out += table_of_sizes(mesh, title);
    return out + offset_histograms(mesh) + "</section>\n";
}

std::string left_out(const ReportPage& page) {
    std::string out;
    for (const auto& [path, why] : page.left_out) {
        out +=
            fmt::format("\n<p class=\"note\">Not in it: <code>{}</code> ({}).</p>", name_html(path), escape_html(why));
    }
    return out;
}

}  // namespace

std::string report_page(const ReportPage& page) {
    const std::size_t count = page.meshes.size();
    const std::string subject =
        count == 1 ? title_of(page.meshes.front(), page.meshes) : fmt::format("{} meshes", count);
    const std::string drawn = page.device.empty()
                                  ? std::string("none: no pictures")
                                  : fmt::format("{}; {} sample{} a pixel, from the lean stream",
                                                escape_html(page.device), page.samples, page.samples == 1 ? "" : "s");
    std::string out = fmt::format(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
        "<meta http-equiv=\"Content-Security-Policy\" content=\"{}\">\n"
        "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
        "<meta name=\"generator\" content=\"lacedring {}\">\n<title>LacedRing report: {}</title>\n<style>{}</style>\n"
        "</head>\n<body>\n<header><h1>LacedRing report{}</h1>\n"
        "<p class=\"note\">What the connectivity of {} costs in every format, measured after each was made and decoded "
        "again.</p>{}</header>\n<main>\n",
        kPolicy, escape_html(page.version), escape_html(subject), kReportStyle, count == 1 ? "" : ": " + subject,
        count == 1 ? "this mesh" : "these meshes", left_out(page));
    if (count > 1) out += overview(page.meshes);
    const BitScale scale = bit_scale(page.meshes);
    for (std::size_t i = 0; i < count; ++i) out += section(page.meshes[i], i + 1, page, scale);
    out += fmt::format(
        "</main>\n<footer><dl class=\"made\"><dt>Made by</dt><dd>lacedring {}</dd>\n<dt>Command</dt>"
        "<dd><code>{}</code></dd>\n<dt>Device</dt><dd>{}</dd></dl></footer>\n</body>\n</html>\n",
        escape_html(page.version), name_html(page.command), drawn);
    return out;
}

}  // namespace lacedring::app
