#include "app/report/charts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "app/report/html.h"

namespace lacedring::app {
namespace {

std::string period_title(std::uint32_t k) {
    if (k == 0) return "k = ∞, depth first";
    return fmt::format("k = {}, {}", k, k == 1 ? "breadth first" : "hybrid");
}

/// One column of the histograms, and one line of their table.
struct Bin {
    std::string label;  ///< under the column
    std::string title;
    std::function<std::uint32_t(const OffsetCounts&)> count;
};

std::vector<Bin> bins(std::span<const PeriodFigures> periods) {
    std::size_t largest = 1;
    for (const PeriodFigures& period : periods) {
        for (std::size_t b = 1; b < period.offsets.bits.size(); ++b) {
            if (period.offsets.bits[b] > 0) largest = std::max(largest, b);
        }
    }
    std::vector<Bin> out;
    for (std::size_t b = 1; b <= largest; ++b) {
        out.push_back({std::to_string(b), fmt::format("{} bit{}", b, b == 1 ? "" : "s"),
                       [b](const OffsetCounts& o) { return o.bits[b]; }});
    }
    out.push_back({"iso", "tip isolated", [](const OffsetCounts& o) { return o.off_ring; }});
    out.push_back({"T0", "T0", [](const OffsetCounts& o) { return o.t0; }});
    return out;
}

std::string histogram(const MeshReport& mesh, const PeriodFigures& period, std::span<const Bin> columns, double top,
                      double tick) {
    constexpr double kLeft = 34, kTop = 10, kWidth = 322, kHeight = 138;
    const double step = kWidth / (static_cast<double>(columns.size()) + 0.6);  // a gap before the last two
    std::string out = fmt::format(
        "<figure class=\"panel\"><figcaption>{}</figcaption>\n<svg viewBox=\"0 0 360 182\" role=\"img\" "
        "aria-label=\"Histogram of offsets, {}: the numbers are in the table below\">\n",
        period_title(period.k), period_title(period.k));
    for (double percent = 0; percent < top + tick / 2; percent += tick) {
        const double y = kTop + kHeight * (1 - percent / top);
        out += fmt::format("<line class=\"grid\" x1=\"{:.1f}\" x2=\"{:.1f}\" y1=\"{:.1f}\" y2=\"{:.1f}\"/>", kLeft,
                           kLeft + kWidth, y, y);
        out += fmt::format("<text class=\"y\" x=\"{:.1f}\" y=\"{:.1f}\">{:.3g}{}</text>\n", kLeft - 4, y + 3.5, percent,
                           percent == 0 ? "" : " %");
    }
    for (std::size_t i = 0; i < columns.size(); ++i) {
        const bool outside = i + 2 >= columns.size();  // no offset along the ring
        const double percent = 100.0 * columns[i].count(period.offsets) / static_cast<double>(mesh.triangles);
        const double x = kLeft + step * (static_cast<double>(i) + (outside ? 0.6 : 0));
        const double height = kHeight * percent / top;
        out += fmt::format(
            "<rect class=\"{}\" x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\">"
            "<title>{}: {:.2f} %</title></rect>",
            outside ? "outside" : "inside", x + 1, kTop + kHeight - height, step - 2, height, columns[i].title,
            percent);
        out += fmt::format("<text class=\"x\" x=\"{:.1f}\" y=\"{:.1f}\">{}</text>\n", x + step / 2, kTop + kHeight + 12,
                           columns[i].label);
    }
    out += fmt::format("<text class=\"x\" x=\"{:.1f}\" y=\"{:.1f}\">significant bits of the offset</text>\n",
                       kLeft + step * static_cast<double>(columns.size() - 2) / 2, kTop + kHeight + 28);
    return out + "</svg></figure>\n";
}

std::string offset_table(const MeshReport& mesh, std::span<const Bin> columns) {
    std::string out =
        "<details><summary>The numbers, in percent of triangles</summary>\n"
        "<div class=\"wide\" role=\"region\" aria-label=\"Offsets along the ring\" tabindex=\"0\">"
        "<table class=\"offsets\"><thead><tr><th scope=\"col\">offset</th>";
    for (const PeriodFigures& period : mesh.periods) {
        out += fmt::format("<th scope=\"col\">{}</th>", period_title(period.k));
    }
    out += "</tr></thead>\n<tbody>\n";
    for (const Bin& bin : columns) {
        out += fmt::format("<tr><th scope=\"row\">{}</th>", bin.title);
        for (const PeriodFigures& period : mesh.periods) {
            const double percent = 100.0 * bin.count(period.offsets) / static_cast<double>(mesh.triangles);
            out += fmt::format("<td>{}</td>", fixed(percent, 2));
        }
        out += "</tr>\n";
    }
    return out + "</tbody></table></div></details>\n";
}

}  // namespace

const char* class_of(Origin origin) {
    return origin == Origin::ours ? "ours" : origin == Origin::paper ? "paper" : "baseline";
}

BitScale bit_scale(std::span<const MeshReport> meshes) {
    BitScale scale;
    for (const MeshReport& mesh : meshes) {
        for (const FormatFigures& format : mesh.formats) {
            if (!std::isfinite(format.bits) || format.bits <= 0) continue;
            scale.low = std::min(scale.low, static_cast<int>(std::floor(std::log2(format.bits))));
            scale.high = std::max(scale.high, static_cast<int>(std::ceil(std::log2(format.bits))));
        }
    }
    return scale;
}

std::string bit_bars(const MeshReport& mesh, const BitScale& scale) {
    std::vector<const FormatFigures*> sorted;
    for (const FormatFigures& format : mesh.formats) sorted.push_back(&format);
    std::ranges::stable_sort(sorted, {}, [](const FormatFigures* f) { return f->bits; });
    const auto place = [&](double power) { return 100 * (power - scale.low) / (scale.high - scale.low); };

    std::string lines, labels;
    for (int power = scale.low; power <= scale.high; ++power) {
        const std::string at = fmt::format("left:{:.2f}%", place(power));
        lines += fmt::format("<i style=\"{}\"></i>", at);
        labels += fmt::format("<i class=\"{}\" style=\"{}\">{:g}</i>", (power & 1) != 0 ? "odd" : "even", at,
                              std::exp2(power));
    }
    std::string out = fmt::format(
        "<figure class=\"bars\">\n<figcaption>Bits per triangle, connectivity alone. Logarithmic scale: at each line "
        "twice as many as at the one before.</figcaption>\n"
        "<ul class=\"key\"><li><span class=\"swatch ours\"></span>lean, packed: this program’s</li>"
        "<li><span class=\"swatch paper\"></span>LR: the paper’s</li>"
        "<li><span class=\"swatch baseline\"></span>baselines</li></ul>\n"
        "<div class=\"chart\">\n<div class=\"lines\" aria-hidden=\"true\"><div>{}</div></div>\n<ul>\n",
        lines);
    for (const FormatFigures* format : sorted) {
        const bool drawn = std::isfinite(format->bits) && format->bits > 0;
        const double width = drawn ? place(std::log2(format->bits)) : 0;
        out += fmt::format(
            "<li><span class=\"name\">{}</span><span class=\"track\" aria-hidden=\"true\"><i class=\"{}\" "
            "style=\"width:{:.2f}%\"></i></span><span class=\"value\">{}</span></li>\n",
            escape_html(format->name), class_of(note_on(format->name).origin), width, fixed(format->bits, 2));
    }
    out +=
        fmt::format("</ul>\n<div class=\"axis\" aria-hidden=\"true\"><div>{}</div></div>\n</div></figure>\n", labels);
    return out;
}

std::string offset_histograms(const MeshReport& mesh) {
    std::string out =
        "<h3>Offsets along the ring</h3>\n<p class=\"note\">How far each triangle’s tip lies from its ring edge, along "
        "the ring, in rings grown with three periods k (section 6.1 and Figure 8 of the paper; LR tables, standard, "
        "not "
        "optimized). ";
    if (mesh.periods.empty() || mesh.triangles == 0) {
        return out + fmt::format("Absent: {}.</p>\n", escape_html(mesh.no_periods));
    }
    out +=
        "Short offsets fit the 16-bit references of lr_compact. <b>iso</b>: the tip is on no ring; <b>T0</b>: the "
        "triangle has no ring edge. Columns: percent of the triangles.</p>\n";
    const std::vector<Bin> columns = bins(mesh.periods);
    double top = 1;
    for (const Bin& bin : columns) {
        for (const PeriodFigures& period : mesh.periods) {
            top = std::max(top, 100.0 * bin.count(period.offsets) / static_cast<double>(mesh.triangles));
        }
    }
    const double step = top <= 5 ? 1 : top <= 10 ? 2 : top <= 30 ? 5 : top <= 60 ? 10 : 20;
    top = step * std::ceil(top / step);
    out += "<div class=\"panels\">\n";
    for (const PeriodFigures& period : mesh.periods) out += histogram(mesh, period, columns, top, step);
    return out + "</div>\n" + offset_table(mesh, columns);
}

}  // namespace lacedring::app
