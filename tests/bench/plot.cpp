#include "tests/bench/plot.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace raywalk::bench {

namespace {

constexpr double panel_width = 400, panel_height = 300;
constexpr double left = 58, right = 14, top = 34, bottom = 44;  // around the axes

std::string format(const char* pattern, double a, double b = 0, double c = 0, double d = 0) {
    char text[256];
    std::snprintf(text, sizeof text, pattern, a, b, c, d);
    return text;
}

// "1", "10", "1 k", "10 M"; "0.01" below one.
std::string power_label(int exponent) {
    if (exponent < 0) return format("%g", std::pow(10.0, exponent));
    static constexpr const char* units[] = {"", " k", " M", " G", " T"};
    return format("%g", std::pow(10.0, exponent % 3)) + units[std::min(exponent / 3, 4)];
}

// From values to points of the picture.
struct Axes {
    double x0, x1;  // log10
    double y0, y1;  // log10, or as they are
    bool even;
    [[nodiscard]] double x(double value) const {
        return left + (std::log10(value) - x0) / (x1 - x0) * (panel_width - left - right);
    }
    [[nodiscard]] double y(double value) const {
        return panel_height - bottom -
               ((even ? value : std::log10(value)) - y0) / (y1 - y0) * (panel_height - top - bottom);
    }
};

// A round step that makes about five of `range`.
double round_step(double range) {
    const double decade = std::pow(10.0, std::floor(std::log10(range / 5)));
    for (const double step : {1.0, 2.0, 5.0})
        if (range / (step * decade) <= 6) return step * decade;
    return 10 * decade;
}

Axes axes_of(const Panel& panel) {
    Axes axes{1e9, -1e9, 1e9, -1e9, panel.even};
    double highest = 0;
    for (const Series& series : panel.series) {
        for (const auto& [x, y] : series.points) {
            axes.x0 = std::min(axes.x0, std::log10(x)), axes.x1 = std::max(axes.x1, std::log10(x));
            axes.y0 = std::min(axes.y0, std::log10(y)), axes.y1 = std::max(axes.y1, std::log10(y));
            highest = std::max(highest, y);
        }
    }
    axes.x0 -= 0.05, axes.x1 += 0.05;
    axes.y0 = std::floor(axes.y0 + 1e-9), axes.y1 = std::max(std::ceil(axes.y1 - 1e-9), axes.y0 + 1);
    if (panel.even) axes.y0 = 0, axes.y1 = round_step(highest) * std::ceil(highest / round_step(highest));
    return axes;
}

std::string text_at(double x, double y, const std::string& anchor, const std::string& text, const char* extra = "") {
    return format("<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"", x, y) + anchor + "\" " + extra + ">" + text +
           "</text>\n";
}

std::string grid_of(const Axes& axes) {
    std::string svg;
    for (int e = static_cast<int>(std::ceil(axes.x0)); e <= static_cast<int>(std::floor(axes.x1)); ++e) {
        const double x = axes.x(std::pow(10.0, e));
        svg += format("<line x1=\"%.1f\" y1=\"%.1f\" x2=\"%.1f\" y2=\"%.1f\"/>\n", x, top, x, panel_height - bottom);
        svg += text_at(x, panel_height - bottom + 15, "middle", power_label(e));
    }
    const auto level = [&](double value, const std::string& label) {
        const double y = axes.y(value);
        svg += format("<line x1=\"%.1f\" y1=\"%.1f\" x2=\"%.1f\" y2=\"%.1f\"/>\n", left, y, panel_width - right, y);
        svg += text_at(left - 6, y + 4, "end", label);
    };
    if (axes.even) {
        const double step = round_step(axes.y1);
        for (int i = 0; i * step <= axes.y1 * 1.001; ++i) level(i * step, format("%g", i * step));
    } else {
        for (int e = static_cast<int>(axes.y0); e <= static_cast<int>(axes.y1); ++e)
            level(std::pow(10.0, e), power_label(e));
    }
    return svg;
}

std::string curve_of(const Series& series, const Axes& axes) {
    std::string points, dots;
    for (const auto& [x, y] : series.points) {
        points += format("%.1f,%.1f ", axes.x(x), axes.y(y));
        if (!series.dashed)
            dots += format("<circle cx=\"%.1f\" cy=\"%.1f\" r=\"3\" fill=\"", axes.x(x), axes.y(y)) + series.color +
                    "\" stroke=\"none\"/>\n";
    }
    return "<polyline fill=\"none\" stroke-width=\"" + std::string(series.dashed ? "1.2" : "2") + "\" stroke=\"" +
           series.color + "\"" + (series.dashed ? " stroke-dasharray=\"5 4\"" : "") + " points=\"" + points + "\"/>\n" +
           dots;
}

std::string panel_svg(const Panel& panel) {
    const Axes axes = axes_of(panel);
    std::string svg = "<g stroke=\"#d8d8d8\" stroke-width=\"1\"><g>\n" + grid_of(axes) + "</g></g>\n";
    svg += text_at(left, 18, "start", panel.title, "font-weight=\"bold\" font-size=\"13\"");
    svg += text_at((left + panel_width - right) / 2, panel_height - 10, "middle", panel.x_axis);
    double legend = top + 14;
    for (const Series& series : panel.series) {
        svg += curve_of(series, axes);
        svg += "<g fill=\"" + series.color + "\">" + text_at(left + 10, legend, "start", series.name) + "</g>";
        legend += 15;
    }
    return svg;
}

}  // namespace

std::string svg_of(const std::vector<Panel>& panels, int columns) {
    const auto count = static_cast<int>(panels.size());
    const int rows = (count + columns - 1) / columns;
    std::string svg = format(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 %.0f %.0f\" "
        "font-family=\"sans-serif\" font-size=\"11\">\n",
        panel_width * columns, panel_height * rows);
    svg += "<style>text { fill: #333; stroke: none } g[fill] > text { fill: inherit }</style>\n";
    svg += "<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n";
    for (int i = 0; i < count; ++i) {
        const int column = i % columns, row = i / columns;
        svg += format("<g transform=\"translate(%.0f %.0f)\">\n", column * panel_width, row * panel_height) +
               panel_svg(panels[static_cast<std::size_t>(i)]) + "</g>\n";
    }
    return svg + "</svg>\n";
}

}  // namespace raywalk::bench
