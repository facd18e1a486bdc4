// Where a picture lies in a window of another shape.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace raywalk {

struct Rectangle {
    int x = 0, y = 0, width = 0, height = 0;  // pixels
    friend bool operator==(const Rectangle&, const Rectangle&) = default;
};

// The largest centred rectangle of the picture's aspect. A picture whose aspect is the window's to within one of its
// own pixels (a preview, rounded to whole pixels) fills the window.
inline Rectangle fit(int width, int height, int window_width, int window_height) {
    const long long across = static_cast<long long>(width) * window_height;
    const long long down = static_cast<long long>(height) * window_width;
    if (std::llabs(across - down) <= std::max(window_width, window_height)) return {0, 0, window_width, window_height};
    if (across > down) {
        const int h = std::max(1, static_cast<int>(std::lround(static_cast<double>(down) / width)));
        return {0, (window_height - h) / 2, window_width, h};
    }
    const int w = std::max(1, static_cast<int>(std::lround(static_cast<double>(across) / height)));
    return {(window_width - w) / 2, 0, w, window_height};
}

}  // namespace raywalk
