// Finds and reads weight files.
#include "apps/mien/networks/model_files.h"

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <span>
#include <utility>

#include "apps/mien/networks/embedded_models.h"
#include "apps/mien/system/failure.h"
#include "apps/mien/system/out_of_memory.h"
#include "apps/mien/system/paths.h"
#include "apps/mien/system/program_path.h"
#include "formats/packed_file.h"

namespace mien::app {

namespace fs = std::filesystem;

namespace {

// Null if `path` is not that of an embedded file.
const EmbeddedModel* embedded_model(std::string_view path) {
  for (const EmbeddedModel& model : embedded_models()) {
    if (path.starts_with(kEmbeddedFolder) && path.ends_with(model.file)) {
      return &model;
    }
  }
  return nullptr;
}

}  // namespace

Blob::Blob(const std::string& path, ExitCode code) {
  if (const EmbeddedModel* model = embedded_model(path)) {
    allocate(model->bytes.size());
    std::memcpy(words_.data(), model->bytes.data(), size_);
    return;
  }
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  if (!file) {
    throw Failure(code, path + ": cannot be opened");
  }
  const std::streamoff end = file.tellg();  // for a folder: the largest number
  std::error_code ignored;
  if (end < 0 || fs::is_directory(path_of(path), ignored)) {
    throw Failure(code, path + ": cannot be read");
  }
  allocate(static_cast<std::size_t>(end));
  file.seekg(0);
  if (!file.read(reinterpret_cast<char*>(words_.data()), static_cast<std::streamsize>(size_))) {
    throw Failure(code, path + ": cannot be read");
  }
}

Blob Blob::unpacked(const Blob& packed) {
  Blob file;
  std::size_t bytes = 0;
  Error error;
  mien_status status = formats::unpacked_bytes(packed.bytes(), bytes, error);
  if (status == MIEN_OK) {
    file.allocate(bytes);
    status = formats::unpack(packed.bytes(), {file.words_.data()->bytes, bytes}, error);
  }
  if (status != MIEN_OK) {
    throw Failure(kExitModel, "packed weights: " + error.message());
  }
  return file;
}

void Blob::allocate(std::size_t bytes) {
  size_ = bytes;
  words_.resize(bytes / sizeof(Line) + 1);  // an empty file has memory as well
}

bool model_exists(const std::string& path) {
  std::error_code ignored;
  return embedded_model(path) != nullptr || fs::exists(path_of(path), ignored);
}

OpenedWeights::OpenedWeights(std::vector<std::string> paths) : paths_(std::move(paths)) {
  std::vector<std::span<const std::byte>> files;
  for (const std::string& path : paths_) {
    const Blob& blob = blobs_.emplace_back(path);
    files.push_back(blob.bytes());
  }
  Error error;
  if (weights_.create(files, false, &error) != MIEN_OK) {
    throw Failure(kExitModel, path_of(error) + ": " + error.message());
  }
}

std::size_t OpenedWeights::bytes() const {
  std::size_t bytes = 0;
  for (const Blob& blob : blobs_) {
    bytes += blob.size();
  }
  return bytes;
}

const std::string& OpenedWeights::path_of(const mien_error_detail& error) const {
  return paths_[error.file < 0 ? 0 : static_cast<std::size_t>(error.file)];
}

std::string models_directory(const std::string& chosen) {
  if (!chosen.empty()) {
    return chosen;
  }
  if (const char* from_environment = std::getenv("MIEN_MODELS")) {
    return from_environment;
  }
  std::error_code ignored;
  for (fs::path folder = program_path().parent_path(); !folder.empty();
       folder = folder.parent_path()) {
    for (const char* place : {"models", "share/mien/models"}) {
      if (fs::exists(folder / place / "basenet.mien", ignored)) {
        return name_of(folder / place);
      }
    }
    if (folder == folder.root_path()) {
      break;
    }
  }
  if (!embedded_models().empty()) {
    return std::string(kEmbeddedFolder);
  }
  throw Failure(kExitModel, "--models: no model files found; use --models DIR or set MIEN_MODELS");
}

std::vector<fs::path> weight_files(const std::string& folder) {
  std::vector<fs::path> files;
  if (folder == kEmbeddedFolder) {
    for (const EmbeddedModel& model : embedded_models()) {
      files.push_back(path_of(folder) / model.file);
    }
    return files;
  }
  std::error_code ignored;
  const OutOfMemoryGuard guard;  // the iterator of libstdc++ allocates in a noexcept function
  for (const auto& entry : fs::directory_iterator(path_of(folder), ignored)) {
    if (entry.path().extension() == ".mien") {
      files.push_back(entry.path());
    }
  }
  std::sort(files.begin(), files.end());
  if (files.empty()) {
    throw Failure(kExitModel, folder + ": no model files");
  }
  return files;
}

}  // namespace mien::app
