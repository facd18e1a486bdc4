// Sixteen points or directions at once: three `Real`s.
#pragma once

#include "tracer/kernels/lanes/lanes.h"

HWY_BEFORE_NAMESPACE();
namespace raywalk {
namespace HWY_NAMESPACE {

struct Vec3 {
    Real x, y, z;
};

HWY_INLINE Vec3 splat3(const float* p) { return {Real(p[0]), Real(p[1]), Real(p[2])}; }

// Of arrays p[axis][ray], sixteen rays from `at` on: as load and store.
template <int size>
HWY_INLINE Vec3 load3(const float (&p)[3][size], int at) {
    return {load(p[0] + at), load(p[1] + at), load(p[2] + at)};
}
template <int size>
HWY_INLINE void store3(Vec3 a, float (&p)[3][size], int at) {
    store(a.x, p[0] + at);
    store(a.y, p[1] + at);
    store(a.z, p[2] + at);
}

HWY_INLINE Vec3 operator+(Vec3 a, Vec3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
HWY_INLINE Vec3 operator-(Vec3 a, Vec3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
HWY_INLINE Vec3 operator-(Vec3 a) { return {-a.x, -a.y, -a.z}; }
HWY_INLINE Vec3 operator*(Vec3 a, Real s) { return {a.x * s, a.y * s, a.z * s}; }
HWY_INLINE Vec3 operator*(Vec3 a, Vec3 b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }

// a * s + b.
HWY_INLINE Vec3 mul_add(Vec3 a, Real s, Vec3 b) {
    return {mul_add(a.x, s, b.x), mul_add(a.y, s, b.y), mul_add(a.z, s, b.z)};
}
HWY_INLINE Real dot(Vec3 a, Vec3 b) { return mul_add(a.x, b.x, mul_add(a.y, b.y, a.z * b.z)); }
HWY_INLINE Vec3 cross(Vec3 a, Vec3 b) {
    return {mul_sub(a.y, b.z, a.z * b.y), mul_sub(a.z, b.x, a.x * b.z), mul_sub(a.x, b.y, a.y * b.x)};
}
HWY_INLINE Vec3 select(Mask condition, Vec3 yes, Vec3 no) {
    return {select(condition, yes.x, no.x), select(condition, yes.y, no.y), select(condition, yes.z, no.z)};
}
HWY_INLINE Vec3 normalize(Vec3 a) { return a * (Real(1.0f) / sqrt(dot(a, a))); }

}  // namespace HWY_NAMESPACE
}  // namespace raywalk
HWY_AFTER_NAMESPACE();
