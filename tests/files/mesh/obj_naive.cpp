#include "tests/files/mesh/obj_naive.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <set>
#include <sstream>
#include <vector>

namespace raywalk {

namespace {

class Writer {
  public:
    explicit Writer(unsigned seed) : random_(seed) {}

    std::string write(std::size_t bytes) {
        text_ = "\xEF\xBB\xBFo a \\\nvn 0 0 1\nvt 0 0\n";
        normals_ = 1;
        for (int i = 0; i < ring; ++i)
            vertex(1000 * std::cos(2 * 3.14159265 * i / ring), 1000 * std::sin(2 * 3.14159265 * i / ring), 0);
        while (text_.size() < bytes) line();
        return text_;
    }

  private:
    static constexpr int ring = 40;  // the first vertices: any of them in order are a convex polygon

    std::size_t below(std::size_t n) { return random_() % n; }
    bool seldom() { return below(200) == 0; }
    double number() { return static_cast<double>(static_cast<int>(random_())) * 1e-7; }
    std::string end() {
        if (below(5) != 0) return "\n";
        constexpr const char* ends[] = {" \r\n", "\t\n", "\r", " # and more \\\n", "\r\r\n"};
        return ends[below(5)];
    }

    void vertex(double x, double y, double z) {
        text_ += "v " + std::to_string(x) + " " + std::to_string(y) + "  " + std::to_string(z);
        if (seldom()) text_ += " 1 0.5 0.5 0.5 and so on";
        if (seldom()) text_ += "#comment";
        text_ += end();
        ++vertices_;
    }

    std::string corner(std::size_t v) {
        const std::size_t n = 1 + below(normals_);
        constexpr const char* signs[] = {"", "", "", "+"};
        std::string text = below(2) ? signs[below(4)] + std::to_string(v) : "-" + std::to_string(vertices_ + 1 - v);
        const std::string normal = below(2) ? std::to_string(n) : "-" + std::to_string(normals_ + 1 - n);
        switch (below(8)) {
            case 0:
                return text + "/1";
            case 1:
                return text + "//" + normal;
            case 2:
                return text + "/1/" + normal;
            case 3:
                return text + "/";
            case 4:
                return text + "//";
            default:
                return text;
        }
    }

    void face() {
        std::vector<std::size_t> corners;
        if (below(2)) {
            for (int i = 0; i < 3; ++i) corners.push_back(1 + below(vertices_));
        } else {
            std::set<std::size_t> some;
            for (std::size_t i = 0, n = 3 + below(4); i < n; ++i) some.insert(1 + below(ring));
            corners.assign(some.begin(), some.end());  // two or one of them sometimes
        }
        text_ += "f";
        for (const std::size_t v : corners) text_ += (below(10) ? " " : " \\\n ") + corner(v);
        if (seldom()) {
            constexpr const char* wrong[] = {" 999999999", " 0", " x", " 1.5", " -999999999"};
            text_ += wrong[below(5)];
        }
        text_ += end();
    }

    void line() {
        switch (below(8)) {
            case 0:
            case 1:
                if (seldom())
                    text_ += "v 1 two 3" + end(), ++vertices_;
                else
                    vertex(number(), number(), number());
                break;
            case 2:
                text_ += (seldom() ? "vn nan 0\t" : "vn " + std::to_string(number()) + " 2 ") + "1" + end();
                ++normals_;
                break;
            case 3:
                text_ += "# a comment " + std::string(below(80), 'x') + end();
                break;
            case 4: {
                constexpr const char* others[] = {"\n", "usemtl red \\\n", "vt 0 \\\n0\r", "l 1 \\\n 2\n",
                                                  "g C:\\\r\n"};
                text_ += others[below(5)];
                break;
            }
            default:
                face();
        }
    }

    std::mt19937 random_;
    std::string text_;
    std::size_t vertices_ = 0, normals_ = 0;
};

bool is_blank_line_end(const std::string& line) {
    const std::size_t last = line.find_last_not_of(" \t\r");
    return last != std::string::npos && line[last] == '\\' && line.find('#') == std::string::npos;
}

// Lines as they count: whatever ends them, continued ones put together, without comments.
std::vector<std::string> lines_of(const std::string& text) {
    std::string plain;
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (text[i] == '\r') {
            const std::size_t other = text.find_first_not_of('\r', i);
            if (other == std::string::npos || text[other] != '\n') plain += '\n';
        } else {
            plain += text[i];
        }
    }
    std::vector<std::string> lines;
    std::istringstream stream(plain);
    for (std::string line; std::getline(stream, line);) {
        if (line.starts_with("\xEF\xBB\xBF")) line.erase(0, 3);
        for (std::string more; line.find_first_of("vfl") == 0 && is_blank_line_end(line);) {
            line.resize(line.rfind('\\'));
            if (!std::getline(stream, more)) break;
            line += " " + more;
        }
        lines.push_back(line.substr(0, line.find('#')));
    }
    return lines;
}

bool read_float(const std::string& word, float& value) {
    char* end = nullptr;
    value = std::strtof(word.c_str(), &end);
    return !word.empty() && *end == '\0' && std::isfinite(value);
}

// From 0; negative ones count backwards. -1 for none.
long index_of(const std::string& word, std::size_t count) {
    if (word.empty() || word.find_first_not_of("+-0123456789") != std::string::npos) return -1;
    const long written = std::stol(word);
    return written < 0 ? static_cast<long>(count) + written : written - 1;
}

}  // namespace

std::string random_obj(unsigned seed, std::size_t bytes) { return Writer(seed).write(bytes); }

TriangleMesh parse_naively(const std::string& text) {
    struct Corner {
        long position, normal;
    };
    TriangleMesh mesh;
    std::vector<std::vector<Corner>> polygons;
    for (const std::string& line : lines_of(text)) {
        std::istringstream words(line);
        std::string word;
        words >> word;
        if (word == "v" || word == "vn") {
            glm::vec3 v;
            bool good = true;
            for (int axis = 0; axis < 3; ++axis) {
                std::string number;
                words >> number;
                good = read_float(number, v[axis]) && good;
            }
            if (word == "vn")
                mesh.normals.push_back(good ? v : glm::vec3(0));
            else
                mesh.positions.push_back(good ? v : glm::vec3(NAN));
        } else if (word == "f") {
            auto& polygon = polygons.emplace_back();
            while (words >> word) {
                const std::size_t slash = word.find('/'), second = word.find('/', slash + 1);
                const std::string normal =
                    slash == std::string::npos || second == std::string::npos ? "" : word.substr(second + 1);
                polygon.push_back(
                    {index_of(word.substr(0, slash), mesh.positions.size()), index_of(normal, mesh.normals.size())});
            }
        }
    }
    const auto is_there = [&](const Corner& c) {
        return c.position >= 0 && c.position < static_cast<long>(mesh.positions.size()) &&
               !std::isnan(mesh.positions[static_cast<std::size_t>(c.position)].x);
    };
    std::erase_if(polygons, [&](const auto& p) { return p.size() < 3 || !std::ranges::all_of(p, is_there); });

    std::map<long, std::uint32_t> kept;  // vertices, in their order
    for (const auto& polygon : polygons)
        for (const Corner& c : polygon) kept[c.position] = 0;
    std::vector<glm::vec3> positions;
    for (auto& [old, place] : kept) {
        place = static_cast<std::uint32_t>(positions.size());
        positions.push_back(mesh.positions[static_cast<std::size_t>(old)]);
    }
    mesh.positions = positions;
    for (const auto& polygon : polygons)
        for (std::size_t i = 2; i < polygon.size(); ++i) {
            std::array<std::uint32_t, 3> face;
            std::array<std::int32_t, 3> normals;
            for (std::size_t c = 0; c < 3; ++c) {
                const Corner& corner = polygon[c == 0 ? 0 : i - 2 + c];
                face[c] = kept[corner.position];
                const long n = corner.normal;
                const bool useful = n >= 0 && mesh.normals[static_cast<std::size_t>(n)] != glm::vec3(0);
                normals[c] = useful ? static_cast<std::int32_t>(n) : -1;
            }
            mesh.faces.push_back(face);
            mesh.normal_faces.push_back(normals);
        }
    return mesh;
}

}  // namespace raywalk
