#include "tracer/description/obj_reader.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstring>
#include <exception>
#include <functional>
#include <optional>
#include <string>
#include <utility>

#include "tracer/description/obj_chunk.h"
#include "tracer/ground/file_bytes.h"

namespace raywalk {

namespace {

// Bytes of a piece: large enough that putting pieces together is cheap, small enough to keep all threads busy.
constexpr std::size_t chunk_bytes = std::size_t{512} << 10;

// Runs body(0..count-1) on all threads; the first exception leaves them all.
void for_each_chunk(std::size_t count, const std::function<void(std::size_t)>& body) {
    std::exception_ptr thrown;
    std::atomic<bool> stop{false};
#pragma omp parallel for schedule(dynamic) if (count > 1)
    for (std::size_t i = 0; i < count; ++i) {
        if (stop) continue;
        try {
            body(i);
        } catch (...) {
            if (!stop.exchange(true)) thrown = std::current_exception();
        }
    }
    if (thrown) std::rethrow_exception(thrown);
}

// Cuts text into pieces of about chunk_bytes that end with a line (never inside a continued one).
std::vector<std::string_view> cut(std::string_view text) {
    std::vector<std::string_view> pieces;
    while (!text.empty()) {
        std::size_t end = std::min(chunk_bytes, text.size());
        while (end < text.size()) {
            const std::size_t newline = std::min(text.find('\n', end), text.size());
            std::size_t last = newline;
            while (last > 0 && text[last - 1] == '\r') --last;
            end = std::min(newline + 1, text.size());
            if (last == 0 || text[last - 1] != '\\') break;
        }
        pieces.push_back(text.substr(0, end));
        text.remove_prefix(end);
    }
    return pieces;
}

// Where a chunk's lists start in the whole file's.
struct Base {
    std::size_t position = 0, normal = 0, face = 0, line = 0;
};

class Assembly {
  public:
    Assembly(std::string_view text, const std::filesystem::path& file, const Limits& limits)
        : pieces_(cut(text)), file_(file.string()), limits_(limits) {}

    TriangleMesh run(std::vector<Diagnostic>& warnings);

  private:
    void parse_pieces();
    void require_no_errors() const;
    void require_counts() const;
    void drop_empty_normals(TriangleMesh& mesh, std::vector<Diagnostic>& warnings) const;
    void resolve(std::size_t chunk, TriangleMesh& mesh);
    [[nodiscard]] Diagnostic diagnostic(Severity severity, const ObjRemark& remark, std::size_t chunk) const;

    // A corner that names a vertex, or a normal, that does not exist.
    struct BadCorner {
        std::size_t chunk, face;
        int corner;
        bool normal;
    };
    [[nodiscard]] Diagnostic out_of_range(const BadCorner& bad) const;

    std::vector<std::string_view> pieces_;
    std::string file_;
    const Limits& limits_;
    std::vector<ObjChunk> chunks_;
    std::vector<Base> bases_;  // one more than chunks: the last one holds the totals
    std::vector<std::optional<BadCorner>> bad_;
    bool has_normals_ = false;
};

Diagnostic Assembly::diagnostic(Severity severity, const ObjRemark& remark, std::size_t chunk) const {
    Diagnostic d = error_at({file_, bases_[chunk].line + remark.line + 1, remark.column, remark.length}, remark.what,
                            remark.expected);
    d.severity = severity;
    quote_line(d, remark.source_line);
    return d;
}

void Assembly::parse_pieces() {
    chunks_.resize(pieces_.size());
    std::atomic<std::uint64_t> faces{0};
    for_each_chunk(pieces_.size(), [&](std::size_t i) {
        if (faces > limits_.triangles) return;  // the budget is broken whatever follows
        chunks_[i] = parse_obj_chunk(pieces_[i], limits_.triangles, limits_.errors);
        faces += chunks_[i].faces.size();
    });
    if (faces > limits_.triangles)
        throw InputError(error_of_file(file_, "has too many triangles", how_to_raise(limits_, &Limits::triangles)));
    bases_.resize(chunks_.size() + 1);
    for (std::size_t i = 0; i < chunks_.size(); ++i) {
        bases_[i + 1] = {bases_[i].position + chunks_[i].positions.size(), bases_[i].normal + chunks_[i].normals.size(),
                         bases_[i].face + chunks_[i].faces.size(), bases_[i].line + chunks_[i].lines};
        has_normals_ |= !chunks_[i].normal_faces.empty();
    }
}

void Assembly::require_no_errors() const {
    std::vector<Diagnostic> errors;
    for (std::size_t i = 0; i < chunks_.size(); ++i) {
        for (const ObjRemark& remark : chunks_[i].errors) {
            errors.push_back(diagnostic(Severity::error, remark, i));
            if (errors.size() < limits_.errors) continue;
            errors.push_back(error_of_file(file_, "stopped after " + std::to_string(errors.size()) + " mistakes",
                                           "--max-errors N shows more"));
            throw InputError(std::move(errors));
        }
    }
    if (!errors.empty()) throw InputError(std::move(errors));
}

void Assembly::require_counts() const {
    const Base& total = bases_.back();
    const auto refuse = [&](std::string what, std::string advice) {
        throw InputError(error_of_file(file_, std::move(what), std::move(advice)));
    };
    if (total.face == 0) refuse("has no faces", "expected an OBJ file with lines such as: f 1 2 3");
    if (std::max(total.position, total.normal) > most_indexed)
        refuse("has too many vertices or normals", "at most " + std::to_string(most_indexed) + " can be counted");
}

Diagnostic Assembly::out_of_range(const BadCorner& bad) const {
    ObjRemark remark = locate_obj_corner(pieces_[bad.chunk], bad.face, bad.corner, bad.normal);
    const std::size_t count = bad.normal ? bases_.back().normal : bases_.back().position;
    const char* start = remark.source_line.data() + remark.column - 1;
    const std::string_view word(start, std::min(remark.length, std::string_view(start, remark.length).find('/')));
    const std::string_view list = bad.normal ? "normals" : "vertices";
    remark.what = "there is no " + std::string(bad.normal ? "normal " : "vertex ") + std::string(word);
    remark.expected = word.starts_with('-') ? "not so many " + std::string(list) + " stand above this line"
                                            : "the file has " + std::to_string(count) + " " + std::string(list);
    remark.length = word.size();
    return diagnostic(Severity::error, remark, bad.chunk);
}

// Moves a chunk into the mesh, its indices made absolute and checked.
void Assembly::resolve(std::size_t i, TriangleMesh& mesh) {
    ObjChunk chunk = std::move(chunks_[i]);
    const Base &base = bases_[i], &total = bases_.back();
    std::ranges::copy(chunk.positions, mesh.positions.begin() + static_cast<std::ptrdiff_t>(base.position));
    std::ranges::copy(chunk.normals, mesh.normals.begin() + static_cast<std::ptrdiff_t>(base.normal));
    // Out of range, below 0 included, becomes something not below `count`.
    const auto absolute = [](std::uint32_t index, std::size_t start) {
        return index & relative_index ? start + (index & ~relative_index) - relative_bias : std::size_t{index};
    };
    const auto fail = [&](std::size_t face, int corner, bool normal) {
        if (!bad_[i]) bad_[i] = {i, face, corner, normal};
    };
    for (std::size_t f = 0; f < chunk.faces.size(); ++f) {
        for (int c = 0; c < 3; ++c) {
            const std::size_t index = absolute(chunk.faces[f][c], base.position);
            if (index >= total.position) fail(f, c, false);
            mesh.faces[base.face + f][c] = static_cast<std::uint32_t>(index);
        }
    }
    for (std::size_t f = 0; f < chunk.normal_faces.size(); ++f) {
        for (int c = 0; c < 3; ++c) {
            if (chunk.normal_faces[f][c] == no_index) continue;
            const std::size_t index = absolute(chunk.normal_faces[f][c], base.normal);
            if (index >= total.normal) fail(f, c, true);
            mesh.normal_faces[base.face + f][c] = static_cast<std::int32_t>(index);
        }
    }
}

// A normal without length is none; one whose square would leave single precision is brought to a length near 1.
void Assembly::drop_empty_normals(TriangleMesh& mesh, std::vector<Diagnostic>& warnings) const {
    constexpr float small = 1e-15f, large = 1e15f;
    std::vector<bool> empty;
    std::size_t dropped = 0;
    for (std::size_t i = 0; i < mesh.normals.size(); ++i) {
        glm::vec3& n = mesh.normals[i];
        const float largest = std::max({std::abs(n.x), std::abs(n.y), std::abs(n.z)});
        if (largest >= small && largest <= large) continue;
        if (largest > 0) {
            const glm::dvec3 scaled = glm::dvec3(n) / static_cast<double>(largest);
            n = glm::vec3(scaled);
            continue;
        }
        empty.resize(mesh.normals.size());
        empty[i] = true;
        ++dropped;
    }
    if (dropped == 0) return;
    for (auto& corners : mesh.normal_faces)
        for (std::int32_t& corner : corners)
            if (corner >= 0 && empty[static_cast<std::size_t>(corner)]) corner = -1;
    warnings.push_back(
        warning_at({file_}, std::to_string(dropped) + (dropped == 1 ? " normal has" : " normals have") + " no length",
                   "the corners that name such a normal get one from the faces around them"));
}

TriangleMesh Assembly::run(std::vector<Diagnostic>& warnings) {
    parse_pieces();
    const auto unknown = std::ranges::find_if(chunks_, [](const ObjChunk& c) { return !c.unknown_words.empty(); });
    if (unknown != chunks_.end())
        warnings.push_back(diagnostic(Severity::warning, unknown->unknown_words[0],
                                      static_cast<std::size_t>(unknown - chunks_.begin())));
    require_no_errors();
    require_counts();
    TriangleMesh mesh;
    mesh.positions.resize(bases_.back().position);
    mesh.normals.resize(bases_.back().normal);
    mesh.faces.resize(bases_.back().face);
    if (has_normals_) mesh.normal_faces.resize(bases_.back().face, {-1, -1, -1});
    bad_.resize(chunks_.size());
    for_each_chunk(chunks_.size(), [&](std::size_t i) { resolve(i, mesh); });
    const auto bad = std::ranges::find_if(bad_, [](const auto& b) { return b.has_value(); });
    if (bad != bad_.end()) throw InputError(out_of_range(**bad));
    drop_empty_normals(mesh, warnings);
    return mesh;
}

}  // namespace

TriangleMesh parse_obj(std::string_view text, const std::filesystem::path& file, const Limits& limits,
                       std::vector<Diagnostic>& warnings) {
    FileBytes padded(text.size());
    std::ranges::copy(text, padded.data());
    return Assembly(padded.text(), file, limits).run(warnings);
}

TriangleMesh read_obj(const std::filesystem::path& file, const Limits& limits, std::vector<Diagnostic>& warnings,
                      const SourceLocation& where) {
    try {
        const FileBytes bytes = read_text_bytes(file, limits.mesh_bytes);
        return Assembly(bytes.text(), file, limits).run(warnings);
    } catch (const FileProblem& problem) {
        const SourceLocation place = where.file.empty() ? SourceLocation{file.string()} : where;
        const std::string what =
            where.file.empty() ? problem.what() : quoted(std::string_view(file.native())) + " " + problem.what();
        throw InputError(error_at(
            place, what, problem.too_large ? how_to_raise(limits, &Limits::mesh_bytes) : "expected an OBJ file"));
    }
}

}  // namespace raywalk
