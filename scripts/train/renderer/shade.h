// Colour of a point of a surface: albedo by material, light from the environment and lamps.
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
  float lod[2];  // mip level for the material's textures
  float overlay_lod[kOverlays];
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
  if (m.albedo == nullptr) return {c.r / 255, c.g / 255, c.b / 255};
  const Vec3 a{m.albedo[int(c.r)], m.albedo[256 + int(c.g)], m.albedo[512 + int(c.b)]};
  return mix(Vec3{1, 1, 1} * luma(a), a, m.saturation);
}

inline Vec3 skin(const Surface& s, const Textures& textures) {
  const Material& m = *s.material;
  Rgba c = textures[size_t(m.texture[0])].sample(s.uv.u, s.uv.v, s.lod[0]);
  if (m.mix > 0) {
    const Rgba d = textures[size_t(m.texture[1])].sample(s.uv.u, s.uv.v, s.lod[1]);
    c = {c.r + m.mix * (d.r - c.r), c.g + m.mix * (d.g - c.g), c.b + m.mix * (d.b - c.b), 255};
  }
  Vec3 colour = looked_up(m, c);
  for (int k = 0; k < kOverlays; ++k) {
    const Overlay& o = m.overlay[k];
    if (o.texture < 0) continue;
    const float u = (s.uv.u - o.rect[0]) / (o.rect[2] - o.rect[0]),
                v = (s.uv.v - o.rect[1]) / (o.rect[3] - o.rect[1]);
    if (u <= 0 || u >= 1 || v <= 0 || v >= 1) continue;
    const float alpha = textures[size_t(o.texture)].sample(u, v, s.overlay_lod[k]).r / 255;
    colour = mix(colour, load(o.colour), o.opacity * alpha);
  }
  // Cloth starts below a line that drops towards the front.
  return s.head.y < m.param[3] - 0.25f * s.head.z ? load(m.param) : colour;
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
  const Rgba c = textures[size_t(m.texture[0])].sample(s.uv.u, s.uv.v, s.lod[0]);
  if (m.mode != kHair) return times(looked_up(m, c), load(m.colour));
  const int level = int(0.3f * c.r + 0.59f * c.g + 0.11f * c.b);
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

inline float power_of_two_power(float x, int squarings) {
  for (int k = 0; k < squarings; ++k) x *= x;
  return x;
}

// Linear light towards the viewer.
inline Vec3 shade(const Surface& s, const Textures& textures, const Light& light,
                  const ShadowMap* shadow) {
  const Material& m = *s.material;
  const Vec3 n = s.normal, view = unit(s.camera * -1.0f);
  const float open = occlusion(s);
  Vec3 diffuse = from_environment(light, n) * open, gleam{0, 0, 0};
  // Light wraps around skin, red the furthest, for what it scatters below the surface.
  const Vec3 wrap = m.mode == kSkin ? Vec3{0.35f, 0.2f, 0.15f} : Vec3{0.1f, 0.1f, 0.1f};
  for (int k = 0; k < light.lamps; ++k) {
    const Vec3 to_lamp = load(light.direction[k]), colour = load(light.colour[k]);
    const float lit = k == 0 && shadow ? shadow->light(s.camera + n * 0.3f, 0.4f) : 1.0f,
                cosine = dot(n, to_lamp);
    const auto wrapped = [&](float w) { return std::max(0.0f, cosine + w) / (1 + w); };
    const float reach = lit * (0.4f + 0.6f * open);
    diffuse =
        diffuse + times(colour, Vec3{wrapped(wrap.x), wrapped(wrap.y), wrapped(wrap.z)}) * reach;
    const float half = std::max(0.0f, dot(n, unit(to_lamp + view)));
    gleam = gleam + colour * (power_of_two_power(half, m.gloss) * lit);
  }
  const float grazing = power_of_two_power(1 - std::max(0.0f, dot(n, view)), 2);
  gleam = gleam + from_environment(light, n * (2 * dot(n, view)) - view) * (0.1f + 0.4f * grazing);
  return (times(albedo(s, textures), diffuse) + gleam * (m.specular * open)) * light.exposure;
}

}  // namespace mien::render
