// Colour of points of surfaces: albedo by material, one at a time; light from the environment and
// lamps, many at a time.
#pragma once
#include "shadow.h"

namespace mien::render {

using Textures = std::vector<Texture>;

struct Surface {
  const Material* material;
  Vec3 head;    // position in the mesh's frame, cm
  Vec3 camera;  // position in camera space, cm
  Vec3 normal;  // camera space, unit, towards the viewer
  Uv uv;
  float span;  // of the triangle in the texture (CornerUv)
  float occlusion;
};

inline float luma(Vec3 c) { return 0.3f * c.x + 0.59f * c.y + 0.11f * c.z; }
inline Vec3 mix(Vec3 a, Vec3 b, float t) { return a + (b - a) * t; }
inline Vec3 times(Vec3 a, Vec3 b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }
inline float smoothstep(float low, float high, float x) {
  const float t = std::clamp((x - low) / (high - low), 0.0f, 1.0f);
  return t * t * (3 - 2 * t);
}

inline Vec3 looked_up(const Material& m, Rgba c) {
  if (m.albedo == nullptr) return {c[0] / 255, c[1] / 255, c[2] / 255};
  const Vec3 a{m.albedo[int(c[0])], m.albedo[256 + int(c[1])], m.albedo[512 + int(c[2])]};
  return mix(Vec3{1, 1, 1} * luma(a), a, m.saturation);
}

inline Rgba texel(const Texture& texture, const Surface& s) {
  return texture.sample(s.uv.u, s.uv.v, texture.detail() + s.span);
}

inline Vec3 laid_over(Vec3 colour, const Overlay& o, const Surface& s, const Textures& textures) {
  if (s.uv.u <= o.rect[0] || s.uv.u >= o.rect[2] || s.uv.v <= o.rect[1] || s.uv.v >= o.rect[3])
    return colour;
  const float width = o.rect[2] - o.rect[0], height = o.rect[3] - o.rect[1];
  const Texture& texture = textures[size_t(o.texture)];
  const float lod = texture.detail() + s.span - 0.5f * fast_log2(width * height);
  const Rgba c = texture.sample((s.uv.u - o.rect[0]) / width, (s.uv.v - o.rect[1]) / height, lod);
  return mix(colour, load(o.colour), o.opacity * c[0] / 255);
}

inline Vec3 skin(const Surface& s, const Textures& textures) {
  const Material& m = *s.material;
  // Cloth starts below a line that drops towards the front.
  if (s.head.y < m.param[3] - 0.25f * s.head.z) return load(m.param);
  Rgba c = texel(textures[size_t(m.texture[0])], s);
  if (m.mix > 0) c += m.mix * (texel(textures[size_t(m.texture[1])], s) - c);
  Vec3 colour = looked_up(m, c);
  for (const Overlay& o : m.overlay)
    if (o.texture >= 0) colour = laid_over(colour, o, s, textures);
  return colour;
}

// Darkening of teeth, gums and tongue with depth; param[0] is the gap of the lips.
inline float depth_in_mouth(const Surface& s) {
  if (s.head.z > 11) return 1;
  const float t = smoothstep(2, 11.5f, s.head.z);
  return (0.08f + 0.92f * t * t) * std::clamp(0.25f + 0.9f * s.material->param[0], 0.0f, 1.0f);
}

inline Vec3 albedo(const Surface& s, const Textures& textures) {
  const Material& m = *s.material;
  if (m.mode == kSkin) return skin(s, textures);
  if (m.mode == kLash || m.texture[0] < 0) return load(m.colour);
  const Rgba c = texel(textures[size_t(m.texture[0])], s);
  if (m.mode != kHair) return times(looked_up(m, c), load(m.colour));
  const int level = int(0.3f * c[0] + 0.59f * c[1] + 0.11f * c[2]);
  return {m.albedo[level], m.albedo[256 + level], m.albedo[512 + level]};
}

inline float occlusion(const Surface& s) {
  const Material& m = *s.material;
  if (m.mode == kInterior) return depth_in_mouth(s);
  if (m.mode == kEye) return 1 - 0.65f * smoothstep(0.1f, 0.75f, s.head.y - m.param[0]);
  return s.occlusion;
}

inline Vec3 from_environment(const Light& light, Vec3 n) {
  const float basis[10] = {n.x * n.x, n.y * n.y, n.z * n.z, n.x * n.y, n.x * n.z,
                           n.y * n.z, n.x,       n.y,       n.z,       1};
  float sum[3] = {};
  for (int c = 0; c < 3; ++c)
    for (int k = 0; k < 10; ++k) sum[c] += light.irradiance[c][k] * basis[k];
  return {std::max(sum[0], 0.0f), std::max(sum[1], 0.0f), std::max(sum[2], 0.0f)};
}

// Surface points to shade, as a structure of arrays.
struct Batch {
  static constexpr int kSize = 1024;
  int count = 0;
  float nx[kSize], ny[kSize], nz[kSize];  // normal
  float vx[kSize], vy[kSize], vz[kSize];  // unit vector to the viewer
  float albedo[3][kSize];
  float open[kSize];      // to the light
  float lit[kSize];       // share of the first lamp that reaches it
  float scatters[kSize];  // 1: skin
  float specular[kSize];
  int32_t gloss[kSize];
  float share[kSize];  // of its pixel
  size_t pixel[kSize];
  float colour[3][kSize];  // result of `light`, linear

  Vec3 normal(int i) const { return {nx[i], ny[i], nz[i]}; }
  Vec3 answer(int i) const { return {colour[0][i], colour[1][i], colour[2][i]}; }

  void add(const Surface& s, const Textures& textures, const ShadowMap* shadow, size_t at,
           float of_pixel) {
    const int i = count++;
    const Vec3 view = unit(s.camera * -1.0f), a = mien::render::albedo(s, textures);
    nx[i] = s.normal.x, ny[i] = s.normal.y, nz[i] = s.normal.z;
    vx[i] = view.x, vy[i] = view.y, vz[i] = view.z;
    albedo[0][i] = a.x, albedo[1][i] = a.y, albedo[2][i] = a.z;
    open[i] = occlusion(s);
    lit[i] = shadow ? shadow->light(s.camera + s.normal * 0.3f, 0.4f) : 1.0f;
    scatters[i] = s.material->mode == kSkin ? 1.0f : 0.0f;
    specular[i] = s.material->specular, gloss[i] = s.material->gloss;
    share[i] = of_pixel, pixel[i] = at;
  }
};

constexpr int kMaxSquarings = 8;  // of the gleam of lamps

inline float max0(float x) { return x > 0 ? x : 0.0f; }

inline float irradiance(const float* k, float x, float y, float z) {
  return max0(k[0] * x * x + k[1] * y * y + k[2] * z * z + k[3] * x * y + k[4] * x * z +
              k[5] * y * z + k[6] * x + k[7] * y + k[8] * z + k[9]);
}

// Light of the environment: all around for the matt part, from one direction for the gleam.
inline void light_from_environment(const Light& light, Batch& b) {
  for (int c = 0; c < 3; ++c) {
    const float* k = light.irradiance[c];
    for (int i = 0; i < b.count; ++i) {
      const float cosine = b.nx[i] * b.vx[i] + b.ny[i] * b.vy[i] + b.nz[i] * b.vz[i];
      const float away = 1 - max0(cosine), grazing = away * away * away * away;
      const float twice = 2 * cosine;
      const float gleam = irradiance(k, twice * b.nx[i] - b.vx[i], twice * b.ny[i] - b.vy[i],
                                     twice * b.nz[i] - b.vz[i]);
      b.colour[c][i] = b.albedo[c][i] * b.open[i] * irradiance(k, b.nx[i], b.ny[i], b.nz[i]) +
                       b.specular[i] * b.open[i] * gleam * (0.1f + 0.4f * grazing);
    }
  }
}

// Light of one lamp. It wraps around skin, red the furthest, because of scattering below the
// surface.
inline void light_from_lamp(const Light& light, int lamp, Batch& b) {
  static constexpr float kSkinWrap[3] = {0.35f, 0.2f, 0.15f}, kWrap = 0.1f;
  const Vec3 to = load(light.direction[lamp]);
  for (int i = 0; i < b.count; ++i) {
    const float lit = lamp == 0 ? b.lit[i] : 1.0f;
    const float cosine = b.nx[i] * to.x + b.ny[i] * to.y + b.nz[i] * to.z;
    const float hx = to.x + b.vx[i], hy = to.y + b.vy[i], hz = to.z + b.vz[i];
    float half = max0(b.nx[i] * hx + b.ny[i] * hy + b.nz[i] * hz) /
                 std::sqrt(hx * hx + hy * hy + hz * hz + 1e-20f);
    for (int k = 0; k < kMaxSquarings; ++k) half = k < b.gloss[i] ? half * half : half;
    const float gleam = half * lit * b.specular[i] * b.open[i];
    const float reach = lit * (0.4f + 0.6f * b.open[i]);
    for (int c = 0; c < 3; ++c) {
      const float wrap = b.scatters[i] > 0 ? kSkinWrap[c] : kWrap;
      const float matt = max0(cosine + wrap) / (1 + wrap) * reach;
      b.colour[c][i] += light.colour[lamp][c] * (b.albedo[c][i] * matt + gleam);
    }
  }
}

// Linear light towards the viewer, into `colour`.
inline void shade(const Light& light, Batch& b) {
  light_from_environment(light, b);
  for (int lamp = 0; lamp < light.lamps; ++lamp) light_from_lamp(light, lamp, b);
  for (auto& channel : b.colour)
    for (int i = 0; i < b.count; ++i) channel[i] *= light.exposure;
}

}  // namespace mien::render
