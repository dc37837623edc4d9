// Largest flows and least cuts in small networks.
#pragma once

#include <cstdint>
#include <vector>

namespace vfplan {

// A network whose capacities are whole numbers, used again and again. Not thread-safe.
class Flow {
public:
    explicit Flow(std::int32_t nodes) : first_(static_cast<std::size_t>(nodes), -1) {}

    static constexpr std::int64_t endless = std::int64_t{1} << 50;

    // Returns the number of the edge; that of its way back is one more.
    std::int32_t add(std::int32_t from, std::int32_t to, std::int64_t capacity);
    void set(std::int32_t edge, std::int64_t capacity) {
        capacity_[static_cast<std::size_t>(edge)] = capacity;
    }
    // Remembers the capacities, and makes them what they were then.
    void keep() { kept_ = capacity_; }
    void restore() {
        capacity_ = kept_;
        work_ += static_cast<std::int64_t>(kept_.size() / 8);
    }

    // The largest flow, or at least `enough` as soon as that much is found.
    std::int64_t run(std::int32_t source, std::int32_t sink, std::int64_t enough);
    // After a flow that was not enough: nodes that the source still reaches, and nodes that still
    // reach the sink. What lies between the two lies in no least cut.
    std::vector<std::uint8_t> source_side(std::int32_t source) const;
    std::vector<std::uint8_t> sink_side(std::int32_t sink) const;
    // Edges looked at so far.
    std::int64_t work() const { return work_; }

private:
    bool levels(std::int32_t source, std::int32_t sink);

    std::vector<std::int32_t> first_;  // edge of each node
    std::vector<std::int32_t> next_;   // edge of the same node
    std::vector<std::int32_t> to_;
    std::vector<std::int64_t> capacity_;
    std::vector<std::int64_t> kept_;
    std::vector<std::int32_t> level_;
    std::vector<std::int32_t> turn_;
    std::vector<std::int32_t> queue_;
    std::vector<std::int32_t> path_;
    std::int64_t work_ = 0;
};

}  // namespace vfplan
