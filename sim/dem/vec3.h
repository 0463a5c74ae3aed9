// A bare three-vector over any arithmetic type, scalar or lanes. The step kernel may not use Eigen:
// its file is compiled once per instruction set, and an inline function shared with other files
// could leave instructions in them that the machine lacks.
#pragma once

#define HOOF_INLINE [[gnu::always_inline]] inline
#define HOOF_INLINE_LAMBDA __attribute__((always_inline))

namespace hoof::sim {

template <typename T>
struct Vec3 {
  T x, y, z;
};

template <typename T>
HOOF_INLINE Vec3<T> operator+(const Vec3<T>& a, const Vec3<T>& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <typename T>
HOOF_INLINE Vec3<T> operator-(const Vec3<T>& a, const Vec3<T>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <typename T>
HOOF_INLINE Vec3<T> operator*(const T& s, const Vec3<T>& a) {
  return {s * a.x, s * a.y, s * a.z};
}
template <typename T>
HOOF_INLINE T dot(const Vec3<T>& a, const Vec3<T>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <typename T>
HOOF_INLINE Vec3<T> cross(const Vec3<T>& a, const Vec3<T>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

}  // namespace hoof::sim
