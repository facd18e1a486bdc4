// Plots as SVG: the x axis in decades, the y axis in decades or evenly.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace raywalk::bench {

struct Series {
    std::string name;
    std::string color;
    std::vector<std::pair<double, double>> points;  // both over 0
    bool dashed = false;                            // a law to compare with, not a measurement
};
struct Panel {
    std::string title, x_axis;
    std::vector<Series> series;
    bool even = false;  // the y axis, from 0
};

// The panels side by side, `columns` in a row.
std::string svg_of(const std::vector<Panel>& panels, int columns);

}  // namespace raywalk::bench
