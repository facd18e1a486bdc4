#include "tracer/files/mesh/obj_reader.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <exception>
#include <glm/common.hpp>
#include <limits>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "tracer/files/blank.h"
#include "tracer/files/mesh/obj_chunk.h"
#include "tracer/files/mesh/obj_origin.h"
#include "tracer/files/mesh/obj_words.h"
#include "tracer/files/mesh/polygons.h"
#include "tracer/ground/file_bytes.h"

namespace raywalk {

namespace {

// Bytes of a piece: large enough that putting pieces together is cheap, small enough to keep all threads busy.
constexpr std::size_t chunk_bytes = std::size_t{512} << 10;

// How much of the mesh comes before a piece.
struct Base {
    std::size_t position = 0, normal = 0, face = 0, line = 0;
};

// A piece of the text.
struct Piece {
    std::string_view text;
    Base base = {};
};

// Cuts text into pieces of about chunk_bytes that end with a line (never inside a continued one).
std::vector<Piece> cut(std::string_view text) {
    std::vector<Piece> pieces;
    while (!text.empty()) {
        std::size_t end = std::min(chunk_bytes, text.size());
        while (end < text.size()) {
            const std::size_t newline = std::min(text.find('\n', end), text.size());
            std::size_t last = newline;
            while (last > 0 && is_blank(text[last - 1])) --last;
            end = std::min(newline + 1, text.size());
            if (last == 0 || text[last - 1] != '\\') break;
        }
        pieces.push_back({.text = text.substr(0, end)});
        text.remove_prefix(end);
    }
    return pieces;
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

struct Box {
    glm::vec3 lower{std::numeric_limits<float>::infinity()}, upper{-std::numeric_limits<float>::infinity()};

    // Not by one that is NaN: it cannot be read.
    void grow(const glm::vec3& p) {
        lower = glm::min(lower, p);
        upper = glm::max(upper, p);
    }
};

class Assembly {
  public:
    // `bytes`: where single carriage returns end lines, they become newlines.
    Assembly(FileBytes& bytes, const std::filesystem::path& file, const Limits& limits)
        : bytes_(bytes),
          text_(bytes.text()),
          pieces_(cut(text_)),
          file_(file.string()),
          limits_(limits),
          origin_(likely_origin(text_)),
          parsed_(pieces_.size()) {}

    TriangleMesh run(std::vector<Diagnostic>& warnings);

  private:
    void read();
    void parse_pieces();
    [[nodiscard]] std::unique_ptr<ObjChunk> spare_chunk();
    void append_in_order(std::size_t piece, std::unique_ptr<ObjChunk> chunk);
    void append(Piece& piece, ObjChunk& chunk);
    void append_faces(ObjChunk& chunk, const Piece& piece, double pieces_left);
    void require_counts() const;
    void require_faces() const;
    void mark_named(std::span<const std::array<std::uint32_t, 3>> faces);
    [[nodiscard]] Box box_of_named() const;
    [[nodiscard]] bool names_what_is_not_there() const;
    [[nodiscard]] glm::dvec3 better_origin() const;
    void drop_useless_normals();
    void drop_unnamed_vertices();
    void cut_polygons(std::vector<Diagnostic>& warnings);

    FileBytes& bytes_;
    std::string_view text_;
    std::vector<Piece> pieces_;
    std::string file_;
    const Limits& limits_;
    glm::dvec3 origin_;                // of the positions
    std::optional<ObjCensus> census_;  // once it is needed
    int readings_ = 0;
    std::atomic<std::uint64_t> faces_{0};  // of the pieces parsed so far

    std::mutex mutex_;                               // guards the four below
    std::vector<std::unique_ptr<ObjChunk>> parsed_;  // by piece, not yet appended
    std::vector<std::unique_ptr<ObjChunk>> spare_;   // whose memory is used again
    std::size_t next_ = 0;                           // to be appended
    bool appending_ = false;                         // some thread does it: the members below are its own

    // Of the pieces appended so far.
    TriangleMesh mesh_;
    PolygonRuns polygons_;
    std::vector<std::uint32_t> lost_vertices_;
    ObjFlaws flaws_;
    Base total_;
    Box box_;                          // of all vertices
    std::vector<std::uint8_t> named_;  // by vertex: does a face name it?
    std::uint64_t normals_named_ = 0;  // one more than the largest index
    // When all is read: vertices that no face names; whether one names a vertex that is not there.
    std::size_t unnamed_ = 0;
    bool names_missing_ = false;
};

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
            const Piece& piece = pieces_[i];
            const ObjReading reading{.most_faces = limits_.triangles,
                                     .origin = origin_,
                                     .census = census_ ? &*census_ : nullptr,
                                     .vertices_before = piece.base.position,
                                     .normals_before = piece.base.normal};
            parse_obj_chunk(piece.text, reading, *chunk);
            if (chunk->lone_returns) {
                unify_line_ends(bytes_.data() + (piece.text.data() - text_.data()), piece.text.size());
                parse_obj_chunk(piece.text, reading, *chunk);
            }
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
    flaws_.append(chunk.flaws, total_.line);
    polygons_.append(chunk.polygons, total_.face);
    for (const std::uint32_t lost : chunk.lost_vertices)
        lost_vertices_.push_back(static_cast<std::uint32_t>(total_.position + lost));
    total_ = {total_.position + chunk.positions.size(), total_.normal + chunk.normals.size(),
              total_.face + chunk.faces.size(), total_.line + chunk.lines};
    const auto left = static_cast<double>(text_.data() + text_.size() - piece.text.data());
    const double pieces_left = left / static_cast<double>(piece.text.size());
    make_room(mesh_.positions, chunk.positions.size(), pieces_left);
    mesh_.positions.insert(mesh_.positions.end(), chunk.positions.begin(), chunk.positions.end());
    make_room(mesh_.normals, chunk.normals.size(), pieces_left);
    mesh_.normals.insert(mesh_.normals.end(), chunk.normals.begin(), chunk.normals.end());
    for (const glm::vec3& p : chunk.positions) box_.grow(p);
    append_faces(chunk, piece, pieces_left);
}

void Assembly::append_faces(ObjChunk& chunk, const Piece& piece, double pieces_left) {
    for (auto& face : chunk.faces)
        for (std::uint32_t& vertex : face) vertex = absolute_index(vertex, piece.base.position);
    mark_named(chunk.faces);
    make_room(mesh_.faces, chunk.faces.size(), pieces_left);
    mesh_.faces.insert(mesh_.faces.end(), chunk.faces.begin(), chunk.faces.end());
    if (chunk.normal_faces.empty() && mesh_.normal_faces.empty()) return;

    make_room(mesh_.normal_faces, total_.face - mesh_.normal_faces.size(), pieces_left);
    mesh_.normal_faces.resize(piece.base.face, {-1, -1, -1});
    static_assert(static_cast<std::int32_t>(no_index) == -1);
    for (const auto& face : chunk.normal_faces) {
        auto& corners = mesh_.normal_faces.emplace_back();
        for (std::size_t c = 0; c < 3; ++c) {
            if (face[c] != no_index) {
                const std::uint32_t normal = absolute_index(face[c], piece.base.normal);
                normals_named_ = std::max(normals_named_, std::uint64_t{normal} + 1);
                corners[c] = static_cast<std::int32_t>(normal);
            } else {
                corners[c] = -1;
            }
        }
    }
    mesh_.normal_faces.resize(total_.face, {-1, -1, -1});
}

// Vertices may follow their faces, but there are no more than a text of this size can hold.
void Assembly::mark_named(std::span<const std::array<std::uint32_t, 3>> faces) {
    const std::size_t most = text_.size() / 2;  // a line has two characters or more
    std::span<std::uint8_t> named(named_);      // not known to change with each mark that is set
    for (const auto& face : faces) {
        const std::size_t last = std::ranges::max(face);
        if (last >= named.size()) {
            if (last < most) named_.resize(std::min(std::max(last + 1, 2 * named_.size()), most));
            names_missing_ = names_missing_ || last >= most;
            named = named_;
        }
        for (const std::uint32_t vertex : face)
            if (vertex < named.size()) named[vertex] = 1;
    }
}

void Assembly::require_counts() const {
    if (std::max(total_.position, total_.normal) <= most_indexed) return;
    throw InputError(error_of_file(file_, "has too many vertices or normals",
                                   "at most " + std::to_string(most_indexed) + " can be counted"));
}

void Assembly::require_faces() const {
    if (total_.face > 0) return;
    std::size_t left_out = 0;
    for (const ObjFlaw flaw : {ObjFlaw::corner, ObjFlaw::few_corners, ObjFlaw::no_vertex, ObjFlaw::lost_vertex})
        left_out += flaws_.count(flaw);
    if (left_out > 0) throw InputError(error_of_file(file_, "has no face that can be read", "see the warnings"));
    throw InputError(error_of_file(file_, "has no faces", "expected an OBJ file with lines such as: f 1 2 3"));
}

Box Assembly::box_of_named() const {
    if (unnamed_ == 0) return box_;
    Box box;
    for (std::size_t v = 0; v < named_.size(); ++v)
        if (named_[v] != 0) box.grow(mesh_.positions[v]);
    return box;
}

bool Assembly::names_what_is_not_there() const {
    return names_missing_ || normals_named_ > total_.normal ||
           std::ranges::any_of(lost_vertices_, [&](std::uint32_t vertex) { return named_[vertex] != 0; });
}

// The one that they have, where that is good enough: it may have been a guess.
glm::dvec3 Assembly::better_origin() const {
    const Box box = box_of_named();
    if (!(box.lower.x <= box.upper.x)) return origin_;
    const glm::dvec3 lower(box.lower), upper(box.upper);
    const glm::dvec3 wanted = origin_for(lower + origin_, upper + origin_);
    const bool wanted_far = wanted != glm::dvec3(0), is_far = origin_ != glm::dvec3(0);
    const bool good = origin_for(lower, upper) == glm::dvec3(0);
    return wanted_far && is_far && good ? origin_ : wanted;
}

// Corners that name a normal of length 0, or one that cannot be read, have none.
void Assembly::drop_useless_normals() {
    if (flaws_.count(ObjFlaw::empty_normal) + flaws_.count(ObjFlaw::normal) == 0) return;
    for (auto& corners : mesh_.normal_faces)
        for (std::int32_t& corner : corners)
            if (corner >= 0 && mesh_.normals[static_cast<std::size_t>(corner)] == glm::vec3(0)) corner = -1;
}

// Vertices that no face names are no part of what is seen, wherever they are.
void Assembly::drop_unnamed_vertices() {
    if (unnamed_ == 0) return;
    std::vector<std::uint32_t> places(mesh_.positions.size());
    std::uint32_t kept = 0;
    for (std::size_t v = 0; v < places.size(); ++v) {
        if (named_[v] == 0) continue;
        mesh_.positions[kept] = mesh_.positions[v];
        places[v] = kept++;
    }
    mesh_.positions.resize(kept);
    for (auto& face : mesh_.faces)
        for (std::uint32_t& vertex : face) vertex = places[vertex];
}

void Assembly::cut_polygons(std::vector<Diagnostic>& warnings) {
    const std::size_t not_cut = cut_concave_polygons(mesh_, polygons_);
    if (not_cut == 0) return;
    warnings.push_back(warning_at(
        {file_},
        std::to_string(not_cut) + (not_cut == 1 ? " concave polygon is" : " concave polygons are") + " shown as a fan",
        "cutting polygons of so many corners into triangles takes too long"));
}

// Once more from the start, with what is known by now.
void Assembly::read() {
    ++readings_;
    faces_ = 0;
    next_ = 0;
    mesh_ = {};
    polygons_.clear();
    lost_vertices_.clear();
    flaws_.clear();
    total_ = {};
    box_ = {};
    normals_named_ = 0;
    named_.clear();
    names_missing_ = false;
    parse_pieces();
    require_counts();
    if (named_.size() > total_.position)
        names_missing_ |=
            std::find(named_.begin() + static_cast<std::ptrdiff_t>(total_.position), named_.end(), 1) != named_.end();
    named_.resize(total_.position);
    unnamed_ = static_cast<std::size_t>(std::ranges::count(named_, 0));
}

TriangleMesh Assembly::run(std::vector<Diagnostic>& warnings) {
    read();
    // At most twice more: what is not there is left out, and then the origin may be another.
    while (readings_ < 3) {
        const glm::dvec3 origin = better_origin();
        const bool needs_census = !census_ && names_what_is_not_there();
        if (!needs_census && origin == origin_) break;
        if (needs_census) census_ = ObjCensus{total_.position, total_.normal, std::move(lost_vertices_)};
        origin_ = origin;
        read();
    }
    const std::vector<Diagnostic> flaws = flaws_.warnings(file_, total_.position, total_.normal);
    warnings.insert(warnings.end(), flaws.begin(), flaws.end());
    require_faces();
    cut_polygons(warnings);
    drop_useless_normals();
    drop_unnamed_vertices();
    mesh_.origin = origin_;
    return std::move(mesh_);
}

void require_single_bytes(std::string_view text, const std::filesystem::path& file) {
    if (text.starts_with("\xFF\xFE") || text.starts_with("\xFE\xFF"))
        throw InputError(error_of_file(file.string(), "is UTF-16 text", "save it as UTF-8 or ASCII text"));
}

TriangleMesh mesh_of(FileBytes& bytes, const std::filesystem::path& file, const Limits& limits,
                     std::vector<Diagnostic>& warnings) {
    require_single_bytes(bytes.text(), file);
    return Assembly(bytes, file, limits).run(warnings);
}

}  // namespace

TriangleMesh parse_obj(std::string_view text, const std::filesystem::path& file, const Limits& limits,
                       std::vector<Diagnostic>& warnings) {
    FileBytes padded(text.size());
    std::ranges::copy(text, padded.data());
    return mesh_of(padded, file, limits, warnings);
}

TriangleMesh read_obj(const std::filesystem::path& file, const Limits& limits, std::vector<Diagnostic>& warnings,
                      const SourceLocation& where, const FileOpener& open) {
    try {
        FileBytes bytes = read_text_bytes(open(file), limits.mesh_bytes);
        return mesh_of(bytes, file, limits, warnings);
    } catch (const FileProblem& problem) {
        const SourceLocation place = where.file.empty() ? SourceLocation{file.string()} : where;
        const std::string what =
            where.file.empty() ? problem.what() : quoted(std::string_view(file.native())) + " " + problem.what();
        throw InputError(error_at(
            place, what, problem.too_large ? how_to_raise(limits, &Limits::mesh_bytes) : "expected an OBJ file"));
    }
}

}  // namespace raywalk
