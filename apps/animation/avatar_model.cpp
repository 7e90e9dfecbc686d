// Unpacks the avatar.
#include "apps/animation/avatar_model.h"

#include <cmath>
#include <cstddef>
#include <span>
#include <string_view>

#include "apps/animation/avatar_data.h"
#include "formats/packed_file.h"

namespace mien::animation {
namespace {

constexpr float kHalfHeadMetres = 0.08f;  // half the width of the head
constexpr float kStep = kHalfHeadMetres / 1024.0f, kTargetStep = kHalfHeadMetres / 512.0f;
constexpr std::array<Vector, 2> kEyes = {{{0.395f, 0.075f, 0.515f}, {-0.395f, 0.075f, 0.515f}}};

struct Part {
  int node, rows, columns, flags, partner;
  std::size_t first;  // vertex

  [[nodiscard]] bool flag(int bit) const { return (flags & bit) != 0; }
  [[nodiscard]] std::size_t size() const {
    return static_cast<std::size_t>(rows) * static_cast<std::size_t>(columns);
  }
  // The column on the other side.
  [[nodiscard]] std::size_t flipped(std::size_t column) const {
    const auto count = static_cast<std::size_t>(columns);
    switch (flags >> 3) {
      case 1:
        return (count + count / 2 - column) % count;
      case 2:
        return count - 1 - column;
      default:
        return column;
    }
  }
};

std::vector<std::byte> unpacked() {
  std::size_t bytes = 0;
  mien_error_detail error{};
  std::vector<std::byte> data;
  if (formats::unpacked_bytes(avatar_data(), bytes, error) == MIEN_OK) {
    data.resize(bytes);
    static_cast<void>(formats::unpack(avatar_data(), data, error));  // zeros if it fails
  }
  return data;
}

class Reader {
 public:
  Reader() : data_(unpacked()) {
    const auto count = static_cast<std::size_t>(next());
    std::size_t first = 0;
    for (std::size_t i = 0; i < count; ++i) {
      Part part{next(), next(), next(), next(), next(), first};
      first += part.size();
      parts.push_back(part);
    }
    size = first;
  }

  // Three numbers per vertex.
  std::vector<std::array<int, 3>> vectors() {
    std::vector<std::array<int, 3>> values(size);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      for (const Part& part : parts) {
        read_grid(part, axis, values);
      }
    }
    return values;
  }

  std::vector<Part> parts;
  std::size_t size = 0;  // vertices

 private:
  int next() {
    std::uint32_t value = 0;
    for (std::uint32_t shift = 0; at_ < data_.size() && shift < 28; shift += 7) {
      const auto byte = std::to_integer<std::uint32_t>(data_[at_++]);
      value |= (byte & 127) << shift;
      if (byte < 128) {
        break;
      }
    }
    const int half = static_cast<int>((value + 1) / 2);
    return value % 2 == 1 ? -half : half;
  }

  void read_grid(const Part& part, std::size_t axis, std::vector<std::array<int, 3>>& values) {
    const auto columns = static_cast<std::size_t>(part.columns);
    for (std::size_t i = 0; i < part.size(); ++i) {
      const std::size_t at = part.first + i;
      const int left = i % columns > 0 ? values[at - 1][axis] : 0;
      const int below = i >= columns ? values[at - columns][axis] : 0;
      const int between = i % columns > 0 && i >= columns ? values[at - columns - 1][axis] : 0;
      values[at][axis] = next() + left + below - between;
    }
  }

  std::vector<std::byte> data_;
  std::size_t at_ = 0;
};

// glTF's colours are linear, those of the pages are sRGB.
std::uint8_t linear(int srgb) {
  const float value = static_cast<float>(srgb) / 255.0f;
  return static_cast<std::uint8_t>(std::lround(255.0f * std::pow(value, 2.2f)));
}

Vector metres(const std::array<int, 3>& steps, float step) {
  return {static_cast<float>(steps[0]) * step, static_cast<float>(steps[1]) * step,
          static_cast<float>(steps[2]) * step};
}

void add_triangles(const Part& part, std::size_t base, std::vector<std::uint16_t>& triangles) {
  const auto columns = static_cast<std::size_t>(part.columns);
  const auto index = [&](std::size_t row, std::size_t column) {
    const std::size_t vertex = row % static_cast<std::size_t>(part.rows) * columns;
    return static_cast<std::uint16_t>(base + vertex + column % columns);
  };
  for (std::size_t row = 0; row + (part.flag(4) ? 0 : 1) < static_cast<std::size_t>(part.rows);
       ++row) {
    for (std::size_t column = 0; column + (part.flag(1) ? 0 : 1) < columns; ++column) {
      const std::uint16_t a = index(row, column), b = index(row, column + 1);
      const std::uint16_t c = index(row + 1, column), d = index(row + 1, column + 1);
      if (part.flag(2)) {
        triangles.insert(triangles.end(), {a, c, b, b, c, d});
      } else {
        triangles.insert(triangles.end(), {a, b, c, b, d, c});
      }
    }
  }
}

Vector minus(const Vector& a, const Vector& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }

// The mean of the normals of adjacent triangles, weighted by area.
void add_normals(AvatarMesh& mesh) {
  mesh.normals.assign(mesh.positions.size(), Vector{});
  for (std::size_t i = 0; i < mesh.triangles.size(); i += 3) {
    const std::span<const std::uint16_t, 3> corners(mesh.triangles.data() + i, 3);
    const Vector& first = mesh.positions[corners[0]];
    const Vector u = minus(mesh.positions[corners[1]], first);
    const Vector v = minus(mesh.positions[corners[2]], first);
    for (const std::uint16_t corner : corners) {
      for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t next = (k + 1) % 3, last = (k + 2) % 3;
        mesh.normals[corner][k] += u[next] * v[last] - u[last] * v[next];
      }
    }
  }
  for (Vector& normal : mesh.normals) {
    const float length = std::hypot(normal[0], normal[1], normal[2]);
    normal = length > 0.0f ? Vector{normal[0] / length, normal[1] / length, normal[2] / length}
                           : Vector{0.0f, 0.0f, 1.0f};
  }
}

// Offsets of a target on the right side, from those on the left.
void add_mirrored(const std::vector<Part>& parts, const std::vector<std::array<int, 3>>& left,
                  std::vector<std::array<int, 3>>& right) {
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const Part& part = parts[i];
    const auto columns = static_cast<std::size_t>(part.columns);
    const std::size_t other =
        parts[static_cast<std::size_t>(static_cast<int>(i) + part.partner)].first;
    for (std::size_t vertex = 0; vertex < part.size(); ++vertex) {
      const std::size_t column = vertex % columns;
      const auto& from = left[other + vertex - column + part.flipped(column)];
      auto& to = right[part.first + vertex];
      to = {to[0] - from[0], to[1] + from[1], to[2] + from[2]};
    }
  }
}

constexpr std::string_view kRight = "Right";

// The control of the left side for one of the right side; else `control`.
std::size_t left_of(std::size_t control) {
  const std::string_view name = formats::kArkitNames[control];
  if (!name.ends_with(kRight)) {
    return control;
  }
  const std::string_view stem = name.substr(0, name.size() - kRight.size());
  for (std::size_t i = 0; i < formats::kControlCount; ++i) {
    const std::string_view other = formats::kArkitNames[i];
    if (other.starts_with(stem) && other.substr(stem.size()) == "Left") {
      return i;
    }
  }
  return control;
}

void read_targets(Reader& reader, AvatarModel& model) {
  std::array<std::vector<std::array<int, 3>>, formats::kControlCount> offsets;
  for (std::size_t i = 0; i < offsets.size(); ++i) {
    offsets[i] = reader.vectors();
    if (const std::size_t left = left_of(i); left != i) {
      add_mirrored(reader.parts, offsets[left], offsets[i]);
    }
    model.targets[i].reserve(model.face.positions.size());
    for (std::size_t vertex = 0; vertex < model.face.positions.size(); ++vertex) {
      model.targets[i].push_back(metres(offsets[i][vertex], kTargetStep));
    }
  }
}

}  // namespace

AvatarModel avatar_model() {
  AvatarModel model;
  Reader reader;
  const auto positions = reader.vectors(), colors = reader.vectors();
  AvatarMesh* const meshes[] = {&model.face, &model.body, &model.eye};
  for (const Part& part : reader.parts) {
    AvatarMesh& mesh = *meshes[part.node];
    add_triangles(part, mesh.positions.size(), mesh.triangles);
    for (std::size_t i = part.first; i < part.first + part.size(); ++i) {
      mesh.positions.push_back(metres(positions[i], kStep));
      mesh.colors.push_back(
          {linear(colors[i][0]), linear(colors[i][1]), linear(colors[i][2]), 255});
    }
  }
  for (AvatarMesh* mesh : meshes) {
    add_normals(*mesh);
  }
  for (std::size_t side = 0; side < 2; ++side) {
    for (std::size_t k = 0; k < 3; ++k) {
      model.eye_centres[side][k] = kEyes[side][k] * kHalfHeadMetres;
    }
  }
  read_targets(reader, model);
  return model;
}

}  // namespace mien::animation
