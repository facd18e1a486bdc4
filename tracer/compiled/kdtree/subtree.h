// A subtree of the kd-tree, built by one thread into its own arrays.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "tracer/compiled/kdtree/node.h"

namespace raywalk::kd {

// Work and result, summed over subtrees.
struct Counts {
    std::uint64_t events = 0, inner_nodes = 0, leaves = 0, empty_leaves = 0, references = 0;
    int depth = 0;
    double cost = 0;  // half areas of inner nodes times KT, of leaves times KI and their blocks
    Counts& operator+=(const Counts& other);
};

// Nodes, leaves and blocks count from 0; nodes[0] is the subtree's root. Shapes of leaf i are
// shapes[leaf_start[i]...leaf_start[i + 1]), triangles before spheres.
struct Subtree {
    std::vector<KdNode> nodes;
    std::vector<KdLeaf> leaves;
    std::vector<std::uint32_t> leaf_start{0};
    std::vector<std::uint32_t> shapes;
    std::uint32_t triangle_blocks = 0, sphere_blocks = 0;
    Counts counts;

    // Makes `node` a leaf of the shapes whose events of one axis these are.
    void add_leaf(std::uint32_t node, const Node& of, const Slots& slots, const Input& input);
};

// Stack of event lists: what is allocated last is released first.
class EventArena {
  public:
    struct Mark {
        std::size_t chunk = 0, used = 0;
    };
    Event* allocate(std::size_t count);
    [[nodiscard]] Mark mark() const { return at_; }
    void release(Mark mark) { at_ = mark; }

  private:
    struct Chunk {
        std::unique_ptr<Event[]> events;
        std::size_t size;
    };
    std::vector<Chunk> chunks_;
    Mark at_;
};

// Reused by one thread from subtree to subtree.
class SubtreeBuilder {
  public:
    // Splits until every cell is a leaf. Takes the slots apart.
    Subtree build(const Input& input, Slots& slots, const Node& root);

  private:
    void split(std::uint32_t index, const Node& node);
    void classify(const Node& node, const Split& split, std::array<std::uint32_t, 2>& sizes);

    const Input* input_ = nullptr;
    Slots* slots_ = nullptr;
    Subtree tree_;
    EventArena arena_;
    std::vector<std::uint32_t> target_, straddlers_;
    NewEvents new_events_;
};

}  // namespace raywalk::kd
