// The SIMD vocabulary: sixteen lanes, whatever the machine. A `Real` is sixteen floats in one AVX-512 register, two
// AVX2, four SSE4 or sixteen scalars, so that a kernel written once has one structure, and one result, on every
// instruction set. Lane by lane the operations are IEEE single precision; only `mul_add` and its kin differ (one
// rounding where the machine fuses: avx2, avx512; two where it does not: scalar, sse4).
#pragma once

#include <cstdint>

#include "tracer/ground/aligned.h"

#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace raywalk {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using RealTag = hn::CappedTag<float, lanes>;
using IntTag = hn::RebindToSigned<RealTag>;
using RealRegister = hn::Vec<RealTag>;
using IntRegister = hn::Vec<IntTag>;
using MaskRegister = hn::Mask<RealTag>;
using IntMaskRegister = hn::Mask<IntTag>;

inline constexpr int register_lanes = static_cast<int>(hn::MaxLanes(RealTag()));
inline constexpr int registers = lanes / register_lanes;

// One statement for each register of a value; unrolled, but for the sixteen "registers" of the scalar build, where that
// would only make the compiler slow.
#undef RAYWALK_EACH
// NOLINTBEGIN(bugprone-macro-parentheses): the name that the loop declares
#if HWY_TARGET == HWY_SCALAR
#define RAYWALK_EACH(i) \
    HWY_UNROLL(1)       \
    for (int i = 0; i < registers; ++i)
#else
#define RAYWALK_EACH(i) \
    HWY_UNROLL(4)       \
    for (int i = 0; i < registers; ++i)
#endif
// NOLINTEND(bugprone-macro-parentheses)

struct Mask {
    MaskRegister m[registers];
};

struct Int {
    IntRegister v[registers];
    Int() = default;
    HWY_INLINE Int(std::int32_t value) { RAYWALK_EACH(i) v[i] = hn::Set(IntTag(), value); }
};

struct Real {
    RealRegister v[registers];
    Real() = default;
    HWY_INLINE Real(float value) { RAYWALK_EACH(i) v[i] = hn::Set(RealTag(), value); }
};

// Unary and binary operations, register by register.
#define RAYWALK_LANES_BINARY(type, result, member, name, expression) \
    HWY_INLINE result name(type a, type b) {                         \
        result r;                                                    \
        RAYWALK_EACH(i) r.member[i] = expression;                    \
        return r;                                                    \
    }
RAYWALK_LANES_BINARY(Real, Real, v, operator+, hn::Add(a.v[i], b.v[i]))
RAYWALK_LANES_BINARY(Real, Real, v, operator-, hn::Sub(a.v[i], b.v[i]))
RAYWALK_LANES_BINARY(Real, Real, v, operator*, hn::Mul(a.v[i], b.v[i]))
RAYWALK_LANES_BINARY(Real, Real, v, operator/, hn::Div(a.v[i], b.v[i]))
RAYWALK_LANES_BINARY(Real, Mask, m, operator<, hn::Lt(a.v[i], b.v[i]))
RAYWALK_LANES_BINARY(Real, Mask, m, operator<=, hn::Le(a.v[i], b.v[i]))
RAYWALK_LANES_BINARY(Real, Mask, m, operator>, hn::Gt(a.v[i], b.v[i]))
RAYWALK_LANES_BINARY(Real, Mask, m, operator>=, hn::Ge(a.v[i], b.v[i]))
RAYWALK_LANES_BINARY(Real, Mask, m, operator==, hn::Eq(a.v[i], b.v[i]))
// The second argument where either is NaN, as the x86 instructions have it.
#if HWY_TARGET == HWY_SCALAR
RAYWALK_LANES_BINARY(Real, Real, v, min, RealRegister(a.v[i].raw < b.v[i].raw ? a.v[i].raw : b.v[i].raw))
RAYWALK_LANES_BINARY(Real, Real, v, max, RealRegister(a.v[i].raw > b.v[i].raw ? a.v[i].raw : b.v[i].raw))
#else
RAYWALK_LANES_BINARY(Real, Real, v, min, hn::Min(a.v[i], b.v[i]))
RAYWALK_LANES_BINARY(Real, Real, v, max, hn::Max(a.v[i], b.v[i]))
#endif
RAYWALK_LANES_BINARY(Real, Real, v, copy_sign, hn::CopySign(a.v[i], b.v[i]))
RAYWALK_LANES_BINARY(Real, Real, v, bit_xor, hn::Xor(a.v[i], b.v[i]))
RAYWALK_LANES_BINARY(Real, Real, v, bit_and, hn::And(a.v[i], b.v[i]))
RAYWALK_LANES_BINARY(Int, Int, v, operator+, hn::Add(a.v[i], b.v[i]))
RAYWALK_LANES_BINARY(Int, Int, v, operator-, hn::Sub(a.v[i], b.v[i]))
RAYWALK_LANES_BINARY(Int, Int, v, operator*, hn::Mul(a.v[i], b.v[i]))
RAYWALK_LANES_BINARY(Int, Int, v, operator&, hn::And(a.v[i], b.v[i]))
RAYWALK_LANES_BINARY(Int, Int, v, operator|, hn::Or(a.v[i], b.v[i]))
RAYWALK_LANES_BINARY(Int, Int, v, operator^, hn::Xor(a.v[i], b.v[i]))
RAYWALK_LANES_BINARY(Int, Int, v, min, hn::Min(a.v[i], b.v[i]))
RAYWALK_LANES_BINARY(Int, Int, v, max, hn::Max(a.v[i], b.v[i]))
RAYWALK_LANES_BINARY(Int, Mask, m, operator==, hn::RebindMask(RealTag(), hn::Eq(a.v[i], b.v[i])))
RAYWALK_LANES_BINARY(Int, Mask, m, operator<, hn::RebindMask(RealTag(), hn::Lt(a.v[i], b.v[i])))
RAYWALK_LANES_BINARY(Int, Mask, m, operator>, hn::RebindMask(RealTag(), hn::Gt(a.v[i], b.v[i])))
RAYWALK_LANES_BINARY(Mask, Mask, m, operator&, hn::And(a.m[i], b.m[i]))
RAYWALK_LANES_BINARY(Mask, Mask, m, operator|, hn::Or(a.m[i], b.m[i]))
RAYWALK_LANES_BINARY(Mask, Mask, m, and_not, hn::AndNot(a.m[i], b.m[i]))  // !a & b
#undef RAYWALK_LANES_BINARY

#define RAYWALK_LANES_UNARY(type, result, member, name, expression) \
    HWY_INLINE result name(type a) {                                \
        result r;                                                   \
        RAYWALK_EACH(i) r.member[i] = expression;                   \
        return r;                                                   \
    }
RAYWALK_LANES_UNARY(Real, Real, v, operator-, hn::Neg(a.v[i]))
RAYWALK_LANES_UNARY(Real, Real, v, abs, hn::Abs(a.v[i]))
RAYWALK_LANES_UNARY(Real, Real, v, sqrt, hn::Sqrt(a.v[i]))
RAYWALK_LANES_UNARY(Real, Real, v, floor, hn::Floor(a.v[i]))
RAYWALK_LANES_UNARY(Real, Int, v, truncate_to_int, hn::ConvertTo(IntTag(), a.v[i]))  // |a| < 2^31
RAYWALK_LANES_UNARY(Int, Real, v, to_real, hn::ConvertTo(RealTag(), a.v[i]))
RAYWALK_LANES_UNARY(Real, Int, v, as_int, hn::BitCast(IntTag(), a.v[i]))  // the bits
RAYWALK_LANES_UNARY(Int, Real, v, as_real, hn::BitCast(RealTag(), a.v[i]))
RAYWALK_LANES_UNARY(Mask, Mask, m, operator!, hn::Not(a.m[i]))
#undef RAYWALK_LANES_UNARY

// True for finite values only: no NaN, no infinity.
HWY_INLINE Mask is_finite(Real a) { return abs(a) < Real(__builtin_inff()); }

template <int bits>
HWY_INLINE Int shift_left(Int a) {
    Int r;
    RAYWALK_EACH(i) r.v[i] = hn::ShiftLeft<bits>(a.v[i]);
    return r;
}
// Of the bits, zeros coming in: not the sign.
template <int bits>
HWY_INLINE Int shift_right(Int a) {
    const hn::RebindToUnsigned<IntTag> unsigned_tag;
    Int r;
    RAYWALK_EACH(i) r.v[i] = hn::BitCast(IntTag(), hn::ShiftRight<bits>(hn::BitCast(unsigned_tag, a.v[i])));
    return r;
}

// a * b + c, a * b - c, c - a * b.
HWY_INLINE Real mul_add(Real a, Real b, Real c) {
    Real r;
    RAYWALK_EACH(i) r.v[i] = hn::MulAdd(a.v[i], b.v[i], c.v[i]);
    return r;
}
HWY_INLINE Real mul_sub(Real a, Real b, Real c) {
    Real r;
    RAYWALK_EACH(i) r.v[i] = hn::MulSub(a.v[i], b.v[i], c.v[i]);
    return r;
}
HWY_INLINE Real neg_mul_add(Real a, Real b, Real c) {
    Real r;
    RAYWALK_EACH(i) r.v[i] = hn::NegMulAdd(a.v[i], b.v[i], c.v[i]);
    return r;
}

HWY_INLINE Real select(Mask condition, Real yes, Real no) {
    Real r;
    RAYWALK_EACH(i) r.v[i] = hn::IfThenElse(condition.m[i], yes.v[i], no.v[i]);
    return r;
}
HWY_INLINE Int select(Mask condition, Int yes, Int no) {
    Int r;
    RAYWALK_EACH(i) r.v[i] = hn::IfThenElse(hn::RebindMask(IntTag(), condition.m[i]), yes.v[i], no.v[i]);
    return r;
}

HWY_INLINE Real& operator+=(Real& a, Real b) { return a = a + b; }
HWY_INLINE Real& operator-=(Real& a, Real b) { return a = a - b; }
HWY_INLINE Real& operator*=(Real& a, Real b) { return a = a * b; }
HWY_INLINE Mask& operator&=(Mask& a, Mask b) { return a = a & b; }
HWY_INLINE Mask& operator|=(Mask& a, Mask b) { return a = a | b; }

// Memory: 64-byte aligned arrays of sixteen.
HWY_INLINE Real load(const float* p) {
    Real r;
    RAYWALK_EACH(i) r.v[i] = hn::Load(RealTag(), p + i * register_lanes);
    return r;
}
HWY_INLINE Int load(const std::int32_t* p) {
    Int r;
    RAYWALK_EACH(i) r.v[i] = hn::Load(IntTag(), p + i * register_lanes);
    return r;
}
HWY_INLINE void store(Real a, float* p) { RAYWALK_EACH(i) hn::Store(a.v[i], RealTag(), p + i * register_lanes); }
HWY_INLINE void store(Int a, std::int32_t* p) { RAYWALK_EACH(i) hn::Store(a.v[i], IntTag(), p + i * register_lanes); }

// The lanes of `condition` side by side from p on, which need not be aligned; up to sixteen elements from p are
// written.
HWY_INLINE void compress_store(Real a, Mask condition, float* p) {
    RAYWALK_EACH(i) {
        hn::StoreU(hn::Compress(a.v[i], condition.m[i]), RealTag(), p);
        p += hn::CountTrue(RealTag(), condition.m[i]);
    }
}
HWY_INLINE void compress_store(Int a, Mask condition, std::int32_t* p) {
    RAYWALK_EACH(i) {
        hn::StoreU(hn::Compress(a.v[i], hn::RebindMask(IntTag(), condition.m[i])), IntTag(), p);
        p += hn::CountTrue(RealTag(), condition.m[i]);
    }
}

// base[index] for every lane: every index must be readable, also in lanes that do not matter.
HWY_INLINE Real gather(const float* base, Int index) {
    Real r;
    RAYWALK_EACH(i) r.v[i] = hn::GatherIndex(RealTag(), base, index.v[i]);
    return r;
}
HWY_INLINE Int gather(const std::int32_t* base, Int index) {
    Int r;
    RAYWALK_EACH(i) r.v[i] = hn::GatherIndex(IntTag(), base, index.v[i]);
    return r;
}

// 0, 1, 2, ... 15.
HWY_INLINE Int lane_numbers() {
    Int r;
    RAYWALK_EACH(i) r.v[i] = hn::Iota(IntTag(), i * register_lanes);
    return r;
}

// Bit l is lane l.
HWY_INLINE std::uint32_t bits(Mask a) {
#if HWY_TARGET <= HWY_AVX3
    return a.m[0].raw;
#else
    std::uint32_t r = 0;
    RAYWALK_EACH(i) {
        std::uint8_t bytes[8] = {};
        hn::StoreMaskBits(RealTag(), a.m[i], bytes);
        r |= static_cast<std::uint32_t>(bytes[0]) << (i * register_lanes);
    }
    return r;
#endif
}
HWY_INLINE Mask mask_of_bits(std::uint32_t b) {
#if HWY_TARGET <= HWY_AVX3
    Mask r;
    r.m[0].raw = static_cast<decltype(r.m[0].raw)>(b);
    return r;
#else
    alignas(64) static constexpr std::int32_t bit_of_lane[lanes] = {1,   2,   4,    8,    16,   32,   64,    128,
                                                                    256, 512, 1024, 2048, 4096, 8192, 16384, 32768};
    const Int lane_bit = load(bit_of_lane);
    return (Int(static_cast<std::int32_t>(b)) & lane_bit) == lane_bit;
#endif
}
inline constexpr std::uint32_t all_lanes = (1u << lanes) - 1;
HWY_INLINE bool any(Mask a) { return bits(a) != 0; }
HWY_INLINE bool none(Mask a) { return bits(a) == 0; }
HWY_INLINE bool all(Mask a) { return bits(a) == all_lanes; }

struct Least {
    template <class V>
    HWY_INLINE V operator()(V a, V b) const {
        return hn::Min(a, b);
    }
};
struct Most {
    template <class V>
    HWY_INLINE V operator()(V a, V b) const {
        return hn::Max(a, b);
    }
};

template <class Combine>
HWY_INLINE RealRegister one_register(Real a, Combine combine) {
    RealRegister r = a.v[0];
    for (int i = 1; i < registers; ++i) r = combine(r, a.v[i]);
    return r;
}

// Over all sixteen lanes; no lane may be NaN.
HWY_INLINE float reduce_min(Real a) { return hn::GetLane(hn::MinOfLanes(RealTag(), one_register(a, Least()))); }
HWY_INLINE float reduce_max(Real a) { return hn::GetLane(hn::MaxOfLanes(RealTag(), one_register(a, Most()))); }

#if HWY_TARGET != HWY_SCALAR
// Halves combined until four lanes are left.
template <class Tag, class Combine>
HWY_INLINE void store_folded(Tag tag, hn::Vec<Tag> a, float (&four)[4], Combine combine) {
    if constexpr (hn::MaxLanes(tag) > 4) {
        const hn::Half<Tag> half;
        store_folded(half, combine(hn::LowerHalf(half, a), hn::UpperHalf(half, a)), four, combine);
    } else {
        hn::StoreU(a, tag, four);
    }
}
#endif
// Of four values at once, which takes half the work of one after the other; four[i] is of values[i].
template <class Combine>
HWY_INLINE void reduce_four(const Real (&values)[4], float (&four)[4], Combine combine) {
    RealRegister r[4];
    for (int n = 0; n < 4; ++n) r[n] = one_register(values[n], combine);
#if HWY_TARGET == HWY_SCALAR
    for (int n = 0; n < 4; ++n) four[n] = hn::GetLane(r[n]);
#else
    // In blocks of four lanes: 0 1 0 1 and 2 3 2 3, then 0 1 2 3; at last block by block.
    const RealTag tag;
    const hn::Repartition<double, RealTag> pairs;
    const auto halved = [&](RealRegister a, RealRegister b) HWY_ATTR {
        return hn::BitCast(pairs, combine(hn::InterleaveLower(tag, a, b), hn::InterleaveUpper(tag, a, b)));
    };
    const auto x = halved(r[0], r[1]), y = halved(r[2], r[3]);
    const auto lower = hn::BitCast(tag, hn::InterleaveLower(pairs, x, y));
    const auto upper = hn::BitCast(tag, hn::InterleaveUpper(pairs, x, y));
    store_folded(tag, combine(lower, upper), four, combine);
#endif
}
HWY_INLINE void reduce_min(const Real (&values)[4], float (&four)[4]) { reduce_four(values, four, Least()); }
HWY_INLINE void reduce_max(const Real (&values)[4], float (&four)[4]) { reduce_four(values, four, Most()); }

HWY_INLINE float lane(Real a, int i) {
    HWY_ALIGN float values[lanes];
    store(a, values);
    return values[i];
}
HWY_INLINE std::int32_t lane(Int a, int i) {
    HWY_ALIGN std::int32_t values[lanes];
    store(a, values);
    return values[i];
}

}  // namespace HWY_NAMESPACE
}  // namespace raywalk
HWY_AFTER_NAMESPACE();
