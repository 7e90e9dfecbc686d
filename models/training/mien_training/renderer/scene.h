// The content of an image, as plain structs shared with ctypes (native.py mirrors them field by
// field).
#pragma once
#include <cstdint>

namespace mien::render {

// Vertices and their use by triangle corners. Pointers are borrowed for the duration of a call.
struct Mesh {
  const float* position;           // [vertices,3] cm, in the mesh's own frame
  const float* occlusion;          // [vertices] 0 hidden .. 1 open to the sky, or null
  const float* uv;                 // [.,2], v up
  const int32_t* corner_position;  // [triangles,3]
  const int32_t* corner_uv;        // [triangles,3]
  const float* pose;  // [3,4] row-major: mesh frame -> camera (x right, y up, z to the viewer), cm
  int32_t vertices;
};

enum Stage : int32_t {
  kOpaque = 0,   // hides landmarks
  kFringe = 1,   // drawn with depth, but does not hide landmarks (lashes)
  kBlended = 2,  // lenses, blended with the surfaces behind them
};

// Triangles [first, first+count) of a mesh with one material.
struct Part {
  int32_t mesh, first, count, material, stage;
  int32_t cull;          // 1: back faces are not drawn
  int32_t casts_shadow;  // 1: drawn into the shadow map
};

enum Mode : int32_t { kSkin, kInterior, kEye, kHair, kSolid, kLens, kLash };

// Images that can be laid over one skin.
constexpr int32_t kOverlays = 6;

// An image laid over a rectangle of the skin: its red channel is the opacity of `colour`.
struct Overlay {
  int32_t texture;  // -1: none
  float rect[4];    // u0, v0, u1, v1
  float colour[3];  // linear
  float opacity;
};

struct Material {
  int32_t mode;
  int32_t texture[2];  // -1: none; the second one is mixed in for kSkin
  float mix;
  const float*
      albedo;        // [3,256] linear albedo of each sRGB byte (kHair: of the luma byte), or null
  float saturation;  // of the albedo, 1 = as it is
  Overlay overlay[kOverlays];
  float colour[3];  // linear
  float specular;
  int32_t gloss;   // Blinn-Phong exponent is 2^gloss
  float param[4];  // kSkin: cloth colour, its upper edge y; kInterior: mouth gap (cm); kEye: lid
                   // height y; kLens: opacity
};

struct Light {
  float irradiance[3][10];  // per colour: coefficients of xx yy zz xy xz yz x y z 1 (Ramamoorthi,
                            // Hanrahan 2001)
  int32_t lamps;
  float direction[3][3];  // to the lamp, camera space, unit
  float colour[3][3];
  int32_t shadow;   // 1: the first lamp casts shadows
  float centre[3];  // of the shadow map, camera space, cm
  float exposure;
};

// Image pixel (x,y) = (u - x0, v - y0) * scale, (u,v) being pixels of the camera's image.
struct View {
  float f_px, centre_x, centre_y;  // of the camera's image
  float x0, y0, scale;
  int32_t width, height;
};

struct Scene {
  const Mesh* meshes;
  const Part* parts;
  const Material* materials;
  int32_t mesh_count, part_count;
  Light light;
  View view;
  const uint8_t* background;  // [height,width,3] sRGB
};

}  // namespace mien::render
