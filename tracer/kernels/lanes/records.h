// Fields of records, one record per lane: gathered, or read once where all lanes share the record, as they mostly do.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>

#include "tracer/kernels/lanes/lanes.h"
#include "tracer/kernels/lanes/vectors.h"

HWY_BEFORE_NAMESPACE();
namespace raywalk {
namespace HWY_NAMESPACE {

class Records {
  public:
    // record[index] of every active lane. There must be a record 0: lanes that are not active read it.
    template <class Record>
    HWY_INLINE Records(const Record* record, Mask active, Int index) : base_(reinterpret_cast<const char*>(record)) {
        static_assert(sizeof(Record) % sizeof(float) == 0);
        const std::uint32_t lanes_active = bits(active);
        const std::int32_t first = lane(index, std::countr_zero(lanes_active | 0x8000u));
        shared_ = none(and_not(index == Int(first), active));
        index_ = select(active, index, Int(0)) * Int(static_cast<std::int32_t>(sizeof(Record) / sizeof(float)));
        if (shared_ && lanes_active != 0) base_ += static_cast<std::size_t>(first) * sizeof(Record);
    }
    // Whether all active lanes have the same record.
    [[nodiscard]] HWY_INLINE bool shared() const { return shared_; }
    [[nodiscard]] HWY_INLINE Real real(std::size_t field) const {
        const float* p = reinterpret_cast<const float*>(base_ + field);
        return shared_ ? Real(*p) : gather(p, index_);
    }
    [[nodiscard]] HWY_INLINE Int integer(std::size_t field) const {
        const std::int32_t* p = reinterpret_cast<const std::int32_t*>(base_ + field);
        return shared_ ? Int(*p) : gather(p, index_);
    }
    [[nodiscard]] HWY_INLINE Vec3 vector(std::size_t field) const {
        return {real(field), real(field + sizeof(float)), real(field + 2 * sizeof(float))};
    }

  private:
    const char* base_;
    Int index_;  // in words
    bool shared_;
};

}  // namespace HWY_NAMESPACE
}  // namespace raywalk
HWY_AFTER_NAMESPACE();
