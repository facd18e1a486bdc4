// Elementary functions in lanes. Cephes' single-precision polynomials (Moshier, 1989) without its branches. Error
// bounds are those that the tests hold them to; no finite argument gives a NaN.
#pragma once

#include "tracer/kernels/lanes/lanes.h"

HWY_BEFORE_NAMESPACE();
namespace raywalk {
namespace HWY_NAMESPACE {

// Relative error at most 3e-7 in [-87, 88]; below it 0, above it exp(88).
HWY_INLINE Real exp(Real x) {
    const Real clamped = min(max(x, Real(-87.0f)), Real(88.0f));
    const Real n = floor(mul_add(clamped, Real(1.44269504f), Real(0.5f)));
    // ln 2 in two parts, the first short enough for n times it to be exact.
    const Real r = neg_mul_add(n, Real(-2.12194440e-4f), neg_mul_add(n, Real(0.693359375f), clamped));
    Real p = Real(1.9875691500e-4f);
    p = mul_add(p, r, Real(1.3981999507e-3f));
    p = mul_add(p, r, Real(8.3334519073e-3f));
    p = mul_add(p, r, Real(4.1665795894e-2f));
    p = mul_add(p, r, Real(1.6666665459e-1f));
    p = mul_add(p, r, Real(5.0000001201e-1f));
    p = mul_add(p * r, r, r + Real(1.0f));
    const Real power_of_two = as_real(shift_left<23>(truncate_to_int(n) + Int(127)));
    return select(x < Real(-87.0f), Real(0.0f), p * power_of_two);
}

// x^n for n >= 0, 0^0 = 1, by squaring: relative error at most 1.3e-7 n.
HWY_INLINE Real power(Real x, Int n) {
    Real result(1.0f);
    while (any(n > Int(0))) {
        result = select((n & Int(1)) == Int(1), result * x, result);
        x *= x;
        n = shift_right<1>(n);
    }
    return result;
}

// Radians; |x| is limited to 1. Absolute error at most 4e-7.
HWY_INLINE Real asin(Real x) {
    const Real a = min(abs(x), Real(1.0f));
    const Mask far = a > Real(0.5f);
    // asin a = pi / 2 - 2 asin sqrt((1 - a) / 2)
    const Real z = select(far, Real(0.5f) * (Real(1.0f) - a), a * a);
    const Real s = select(far, sqrt(z), a);
    Real p = Real(4.2163199048e-2f);
    p = mul_add(p, z, Real(2.4181311049e-2f));
    p = mul_add(p, z, Real(4.5470025998e-2f));
    p = mul_add(p, z, Real(7.4953002686e-2f));
    p = mul_add(p, z, Real(1.6666752422e-1f));
    p = mul_add(p * z, s, s);
    return copy_sign(select(far, Real(1.57079633f) - (p + p), p), x);
}

// Radians in [-pi, pi], 0 for (0, 0). Absolute error at most 6e-7 for |x| + |y| in [1e-30, 1e38].
HWY_INLINE Real atan2(Real y, Real x) {
    const Real ax = abs(x), ay = abs(y), longer = max(ax, ay), shorter = min(ax, ay);
    // atan q = pi / 4 + atan((q - 1) / (q + 1))
    const Mask far = shorter > Real(0.41421356f) * longer;
    const Real q = select(far, shorter - longer, shorter) / max(select(far, shorter + longer, longer), Real(1e-37f));
    const Real z = q * q;
    Real p = Real(8.05374449538e-2f);
    p = mul_sub(p, z, Real(1.38776856032e-1f));
    p = mul_add(p, z, Real(1.99777106478e-1f));
    p = mul_sub(p, z, Real(3.33329491539e-1f));
    p = mul_add(p * z, q, q);
    p = select(far, p + Real(0.785398163f), p);
    p = select(ay > ax, Real(1.57079633f) - p, p);
    p = select(x < Real(0.0f), Real(3.14159265f) - p, p);
    return copy_sign(p, y);
}

}  // namespace HWY_NAMESPACE
}  // namespace raywalk
HWY_AFTER_NAMESPACE();
