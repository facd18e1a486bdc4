#include "tracer/files/mesh/obj_reader.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <exception>
#include <iterator>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <string>
#include <utility>

#include "tracer/files/mesh/obj_chunk.h"
#include "tracer/ground/file_bytes.h"

namespace raywalk {

namespace {

// Bytes of a piece: large enough that putting pieces together is cheap, small enough to keep all threads busy.
constexpr std::size_t chunk_bytes = std::size_t{512} << 10;

// How much of the mesh comes before a piece.
struct Base {
    std::size_t position = 0, normal = 0, face = 0, line = 0;
};

// A piece of the text, and what is kept of it when its lists are in the mesh.
struct Piece {
    std::string_view text;
    Base base = {};
    std::vector<ObjRemark> errors = {}, unknown_words = {};
    // One more than the largest indices of its corners, for a test when all vertices and normals are counted.
    std::uint64_t positions_named = 0, normals_named = 0;
};

// Cuts text into pieces of about chunk_bytes that end with a line (never inside a continued one).
std::vector<Piece> cut(std::string_view text) {
    std::vector<Piece> pieces;
    while (!text.empty()) {
        std::size_t end = std::min(chunk_bytes, text.size());
        while (end < text.size()) {
            const std::size_t newline = std::min(text.find('\n', end), text.size());
            std::size_t last = newline;
            while (last > 0 && text[last - 1] == '\r') --last;
            end = std::min(newline + 1, text.size());
            if (last == 0 || text[last - 1] != '\\') break;
        }
        pieces.push_back({.text = text.substr(0, end)});
        text.remove_prefix(end);
    }
    return pieces;
}

// An index of a chunk as one into the whole file's list, in which `start` entries come before the chunk. What would be
// below 0 is larger than any list is long.
std::uint32_t absolute(std::uint32_t index, std::size_t start) {
    return index & relative_index ? static_cast<std::uint32_t>(start) + (index & ~relative_index) - relative_bias
                                  : index;
}

// Makes all indices absolute. Returns one more than the largest.
std::uint64_t make_absolute(std::vector<std::array<std::uint32_t, 3>>& faces, std::size_t start) {
    std::uint64_t end = 0;
    for (auto& face : faces) {
        for (std::uint32_t& index : face) {
            if (index == no_index) continue;
            index = absolute(index, start);
            end = std::max(end, std::uint64_t{index} + 1);
        }
    }
    return end;
}

// Makes room for `more` elements; if there is none, then for all that the rest of the text will bring, were it as full
// of them as the piece that brings these: lists that grow step by step are copied, and their memory touched, anew.
template <class T>
void make_room(std::vector<T>& list, std::size_t more, double pieces_left) {
    constexpr double most_bytes = 1e9;
    if (list.capacity() - list.size() >= more) return;
    const double expected = std::min(1.05 * pieces_left * static_cast<double>(more), most_bytes / sizeof(T));
    list.reserve(std::max(list.size() + more + static_cast<std::size_t>(expected), 2 * list.size()));
}

class Assembly {
  public:
    Assembly(std::string_view text, const std::filesystem::path& file, const Limits& limits)
        : text_(text), pieces_(cut(text)), file_(file.string()), limits_(limits), parsed_(pieces_.size()) {}

    TriangleMesh run(std::vector<Diagnostic>& warnings);

  private:
    void parse_pieces();
    [[nodiscard]] std::unique_ptr<ObjChunk> spare_chunk();
    void append_in_order(std::size_t piece, std::unique_ptr<ObjChunk> chunk);
    void append(Piece& piece, ObjChunk& chunk);
    void append_faces(ObjChunk& chunk, Piece& piece, double pieces_left);
    void require_no_errors() const;
    void require_counts() const;
    void require_indices() const;
    void drop_empty_normals(std::vector<Diagnostic>& warnings);
    [[nodiscard]] Diagnostic diagnostic(Severity severity, const ObjRemark& remark, const Piece& piece) const;

    // A corner that names a vertex, or a normal, that does not exist.
    struct BadCorner {
        std::size_t face;
        int corner;
        bool normal;
    };
    [[nodiscard]] BadCorner find_bad_corner(const Piece& piece) const;
    [[nodiscard]] Diagnostic out_of_range(const Piece& piece, const BadCorner& bad) const;

    std::string_view text_;
    std::vector<Piece> pieces_;
    std::string file_;
    const Limits& limits_;
    std::atomic<std::uint64_t> faces_{0};  // of the pieces parsed so far

    std::mutex mutex_;                               // guards the four below
    std::vector<std::unique_ptr<ObjChunk>> parsed_;  // by piece, not yet appended
    std::vector<std::unique_ptr<ObjChunk>> spare_;   // whose memory is used again
    std::size_t next_ = 0;                           // to be appended
    bool appending_ = false;                         // some thread does it: the members below are its own

    TriangleMesh mesh_;
    Base total_;                     // of the pieces appended so far
    std::size_t empty_normals_ = 0;  // of the pieces appended so far
};

Diagnostic Assembly::diagnostic(Severity severity, const ObjRemark& remark, const Piece& piece) const {
    Diagnostic d = error_at({file_, piece.base.line + remark.line + 1, remark.column, remark.length}, remark.what,
                            remark.expected);
    d.severity = severity;
    quote_line(d, remark.source_line);
    return d;
}

// Each thread parses a piece into a chunk that stays in its cache. The chunks go into the mesh one after the other, in
// the order of the text, while other threads parse on.
void Assembly::parse_pieces() {
    std::exception_ptr thrown;
    std::atomic<bool> stop{false};
#pragma omp parallel for schedule(dynamic) if (pieces_.size() > 1)
    for (std::size_t i = 0; i < pieces_.size(); ++i) {
        if (stop) continue;
        try {
            std::unique_ptr<ObjChunk> chunk = spare_chunk();
            parse_obj_chunk(pieces_[i].text, limits_.triangles, limits_.errors, *chunk);
            if ((faces_ += chunk->faces.size()) > limits_.triangles) stop = true;  // broken whatever follows
            append_in_order(i, std::move(chunk));
        } catch (...) {
            if (!stop.exchange(true)) thrown = std::current_exception();
        }
    }
    if (thrown) std::rethrow_exception(thrown);
    if (faces_ > limits_.triangles)
        throw InputError(error_of_file(file_, "has too many triangles", how_to_raise(limits_, &Limits::triangles)));
}

std::unique_ptr<ObjChunk> Assembly::spare_chunk() {
    const std::scoped_lock lock(mutex_);
    if (spare_.empty()) return std::make_unique<ObjChunk>();
    std::unique_ptr<ObjChunk> chunk = std::move(spare_.back());
    spare_.pop_back();
    return chunk;
}

// No thread waits for its turn: a chunk whose turn has not come is left for the thread that appends those before it.
void Assembly::append_in_order(std::size_t i, std::unique_ptr<ObjChunk> chunk) {
    std::unique_lock lock(mutex_);
    parsed_[i] = std::move(chunk);
    if (appending_) return;
    appending_ = true;
    for (; next_ < parsed_.size() && parsed_[next_]; ++next_) {
        std::unique_ptr<ObjChunk> turn = std::move(parsed_[next_]);
        lock.unlock();
        append(pieces_[next_], *turn);
        lock.lock();
        spare_.push_back(std::move(turn));
    }
    appending_ = false;
}

// Moves a chunk's lists into the mesh, its indices made absolute.
void Assembly::append(Piece& piece, ObjChunk& chunk) {
    piece.base = total_;
    piece.errors = std::move(chunk.errors);
    piece.unknown_words = std::move(chunk.unknown_words);
    total_ = {total_.position + chunk.positions.size(), total_.normal + chunk.normals.size(),
              total_.face + chunk.faces.size(), total_.line + chunk.lines};
    empty_normals_ += chunk.empty_normals;
    const auto left = static_cast<double>(text_.data() + text_.size() - piece.text.data());
    const double pieces_left = left / static_cast<double>(piece.text.size());
    make_room(mesh_.positions, chunk.positions.size(), pieces_left);
    mesh_.positions.insert(mesh_.positions.end(), chunk.positions.begin(), chunk.positions.end());
    make_room(mesh_.normals, chunk.normals.size(), pieces_left);
    mesh_.normals.insert(mesh_.normals.end(), chunk.normals.begin(), chunk.normals.end());
    append_faces(chunk, piece, pieces_left);
}

void Assembly::append_faces(ObjChunk& chunk, Piece& piece, double pieces_left) {
    piece.positions_named = make_absolute(chunk.faces, piece.base.position);
    make_room(mesh_.faces, chunk.faces.size(), pieces_left);
    mesh_.faces.insert(mesh_.faces.end(), chunk.faces.begin(), chunk.faces.end());
    if (chunk.normal_faces.empty() && mesh_.normal_faces.empty()) return;

    using Corners = std::array<std::int32_t, 3>;
    static_assert(static_cast<std::int32_t>(no_index) == -1);
    piece.normals_named = make_absolute(chunk.normal_faces, piece.base.normal);
    make_room(mesh_.normal_faces, total_.face - mesh_.normal_faces.size(), pieces_left);
    mesh_.normal_faces.resize(piece.base.face, {-1, -1, -1});
    std::ranges::transform(chunk.normal_faces, std::back_inserter(mesh_.normal_faces),
                           [](const auto& corners) { return std::bit_cast<Corners>(corners); });
    mesh_.normal_faces.resize(total_.face, {-1, -1, -1});
}

void Assembly::require_no_errors() const {
    std::vector<Diagnostic> errors;
    for (const Piece& piece : pieces_) {
        for (const ObjRemark& remark : piece.errors) {
            errors.push_back(diagnostic(Severity::error, remark, piece));
            if (errors.size() < limits_.errors) continue;
            errors.push_back(error_of_file(file_, "stopped after " + std::to_string(errors.size()) + " mistakes",
                                           "--max-errors N shows more"));
            throw InputError(std::move(errors));
        }
    }
    if (!errors.empty()) throw InputError(std::move(errors));
}

void Assembly::require_counts() const {
    const auto refuse = [&](std::string what, std::string advice) {
        throw InputError(error_of_file(file_, std::move(what), std::move(advice)));
    };
    if (total_.face == 0) refuse("has no faces", "expected an OBJ file with lines such as: f 1 2 3");
    if (std::max(total_.position, total_.normal) > most_indexed)
        refuse("has too many vertices or normals", "at most " + std::to_string(most_indexed) + " can be counted");
}

void Assembly::require_indices() const {
    for (const Piece& piece : pieces_)
        if (piece.positions_named > total_.position || piece.normals_named > total_.normal)
            throw InputError(out_of_range(piece, find_bad_corner(piece)));
}

// The first of a piece that has one.
Assembly::BadCorner Assembly::find_bad_corner(const Piece& piece) const {
    ObjChunk chunk;
    parse_obj_chunk(piece.text, limits_.triangles, limits_.errors, chunk);
    for (std::size_t f = 0; f < chunk.faces.size(); ++f)
        for (std::size_t c = 0; c < 3; ++c)
            if (absolute(chunk.faces[f][c], piece.base.position) >= total_.position)
                return {f, static_cast<int>(c), false};
    for (std::size_t f = 0; f < chunk.normal_faces.size(); ++f)
        for (std::size_t c = 0; c < 3; ++c)
            if (chunk.normal_faces[f][c] != no_index &&
                absolute(chunk.normal_faces[f][c], piece.base.normal) >= total_.normal)
                return {f, static_cast<int>(c), true};
    throw std::logic_error("no corner is out of range");
}

Diagnostic Assembly::out_of_range(const Piece& piece, const BadCorner& bad) const {
    ObjRemark remark = locate_obj_corner(piece.text, bad.face, bad.corner, bad.normal);
    const std::size_t count = bad.normal ? total_.normal : total_.position;
    const char* start = remark.source_line.data() + remark.column - 1;
    const std::string_view word(start, std::min(remark.length, std::string_view(start, remark.length).find('/')));
    const std::string_view list = bad.normal ? "normals" : "vertices";
    remark.what = "there is no " + std::string(bad.normal ? "normal " : "vertex ") + std::string(word);
    remark.expected = word.starts_with('-') ? "not so many " + std::string(list) + " stand above this line"
                                            : "the file has " + std::to_string(count) + " " + std::string(list);
    remark.length = word.size();
    return diagnostic(Severity::error, remark, piece);
}

void Assembly::drop_empty_normals(std::vector<Diagnostic>& warnings) {
    if (empty_normals_ == 0) return;
    for (auto& corners : mesh_.normal_faces)
        for (std::int32_t& corner : corners)
            if (corner >= 0 && mesh_.normals[static_cast<std::size_t>(corner)] == glm::vec3(0)) corner = -1;
    warnings.push_back(warning_at(
        {file_},
        std::to_string(empty_normals_) + (empty_normals_ == 1 ? " normal has" : " normals have") + " no length",
        "the corners that name such a normal get one from the faces around them"));
}

TriangleMesh Assembly::run(std::vector<Diagnostic>& warnings) {
    parse_pieces();
    const auto unknown = std::ranges::find_if(pieces_, [](const Piece& p) { return !p.unknown_words.empty(); });
    if (unknown != pieces_.end())
        warnings.push_back(diagnostic(Severity::warning, unknown->unknown_words[0], *unknown));
    require_no_errors();
    require_counts();
    require_indices();
    drop_empty_normals(warnings);
    return std::move(mesh_);
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
