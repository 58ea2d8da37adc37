// SPDX-License-Identifier: Apache-2.0
#include "model.hpp"

#include <assimp/BaseImporter.h>
#include <assimp/MemoryIOWrapper.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <algorithm>
#include <assimp/IOSystem.hpp>
#include <assimp/Importer.hpp>

#include <cstring>
#include <filesystem>

#include "altiplan/error.hpp"
#include "altiplan/formats/input_file.hpp"
#include "text_check.hpp"

namespace altiplan::mesh {
namespace {
namespace fs = std::filesystem;

/// Maximum size of a triangle in a file, as text with long numbers.
constexpr std::uintmax_t kBytesOfTriangle = 512;
constexpr double kMaxCoordinate = 1e9;
constexpr std::size_t kStlHeader = 80;
constexpr std::size_t kStlTriangle = 50;

[[noreturn]] void refuse(const std::string& file, const std::string& why) {
  throw ParameterError("file", file + ": " + why);
}

std::string read(const std::string& file, std::int64_t max_triangles) {
  if (const std::string why = formats::why_unreadable(file); !why.empty()) {
    refuse(file, why);
  }
  const std::uintmax_t size = fs::file_size(file);
  if (size / kBytesOfTriangle > std::uintmax_t(max_triangles)) {
    throw ParameterError("max_triangles",
                         file + ": has " + std::to_string(size) + " bytes, more than " +
                             std::to_string(kBytesOfTriangle) + " for each of max_triangles (" +
                             std::to_string(max_triangles) + ")");
  }
  return formats::read_file(file, kBytesOfTriangle * (std::uintmax_t(max_triangles) + 1));
}

/// A binary file is recognised by its length, as it may also begin with `solid`.
void check_stl(const std::string& file, const std::string& bytes, std::int64_t max_triangles) {
  const bool has_count = bytes.size() >= kStlHeader + 4;
  std::uint32_t count = 0;
  std::memcpy(&count, bytes.data() + kStlHeader, has_count ? 4 : 0);
  if (has_count && bytes.size() == kStlHeader + 4 + kStlTriangle * std::size_t(count)) {
    if (count > max_triangles) {
      throw ParameterError("max_triangles", file + ": has " + std::to_string(count) +
                                                " triangles, more than max_triangles (" +
                                                std::to_string(max_triangles) + ")");
    }
  } else if (bytes.find_first_not_of(" \t\r\n") != bytes.npos &&
             bytes.compare(bytes.find_first_not_of(" \t\r\n"), 5, "solid") == 0) {
    check_stl_text(file, bytes, max_triangles);
  } else if (has_count) {
    refuse(file, "is not an STL file: it does not begin with 'solid', and a binary one of " +
                     std::to_string(count) + " triangles, as it declares, has " +
                     std::to_string(kStlHeader + 4 + kStlTriangle * std::size_t(count)) +
                     " bytes, found " + std::to_string(bytes.size()));
  } else {
    refuse(file, "is not an STL file: it has " + std::to_string(bytes.size()) +
                     " bytes and does not begin with 'solid'");
  }
}

/// The only file that assimp may open; files that it references do not exist.
class OneFile final : public Assimp::IOSystem {
 public:
  OneFile(std::string name, const std::string& bytes) : name_(std::move(name)), bytes_(bytes) {}

  bool Exists(const char* name) const override { return name_ == name; }
  char getOsSeparator() const override { return '/'; }
  Assimp::IOStream* Open(const char* name, const char*) override {
    return Exists(name) ? new Assimp::MemoryIOStream(
                              reinterpret_cast<const std::uint8_t*>(bytes_.data()), bytes_.size())
                        : nullptr;
  }
  void Close(Assimp::IOStream* stream) override { delete stream; }

 private:
  std::string name_;
  const std::string& bytes_;
};

/// Keeps only the reader for that extension of assimp's fifty.
void leave_one_reader(Assimp::Importer& importer, const std::string& ending) {
  Assimp::BaseImporter* const kept = importer.GetImporter(ending.c_str());
  for (std::size_t i = importer.GetImporterCount(); i-- > 0;) {
    Assimp::BaseImporter* const other = importer.GetImporter(i);
    if (other != kept) {
      importer.UnregisterLoader(other);
      delete other;
    }
  }
}

Model model_of(const aiScene& scene, const std::string& file) {
  Model model;
  for (unsigned n = 0; n < scene.mNumMeshes; ++n) {
    const aiMesh& mesh = *scene.mMeshes[n];
    const auto before = std::uint32_t(model.corners.size());
    for (unsigned i = 0; i < mesh.mNumVertices; ++i) {
      const aiVector3D& v = mesh.mVertices[i];
      model.corners.emplace_back(double(v.x), double(v.y), double(v.z));
      const Vec3& corner = model.corners.back();
      if (!is_finite(corner) || corner.cwiseAbs().maxCoeff() > kMaxCoordinate) {
        refuse(file, "has a coordinate that is not a number of at most 1e+09, its corner " +
                         std::to_string(before + i + 1));
      }
    }
    for (unsigned i = 0; i < mesh.mNumFaces; ++i) {
      const aiFace& face = mesh.mFaces[i];
      if (face.mNumIndices == 3) {  // a polygon without area may leave a line or a point
        model.triangles.push_back(
            {before + face.mIndices[0], before + face.mIndices[1], before + face.mIndices[2]});
      }
    }
  }
  return model;
}
}  // namespace

Model read_model(const std::string& file, std::int64_t max_triangles) {
  std::string ending = fs::path(file).extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char letter) { return char(std::tolower(letter)); });
  if (ending != ".stl" && ending != ".obj") {
    refuse(file, "expected a file that ends in .stl or .obj");
  }
  std::string bytes = read(file, max_triangles);
  if (ending == ".stl") {
    check_stl(file, bytes, max_triangles);
  } else {
    bytes = obj_without_looks(file, bytes, max_triangles);
  }
  const std::string name = "model" + ending;
  Assimp::Importer importer;
  leave_one_reader(importer, ending);
  importer.SetIOHandler(new OneFile(name, bytes));  // the importer deletes it
  const aiScene* scene = importer.ReadFile(name, aiProcess_Triangulate);
  if (scene == nullptr) {
    refuse(file, std::string("cannot be read: ") + importer.GetErrorString());
  }
  Model model = model_of(*scene, file);
  if (model.triangles.empty()) {
    refuse(file, "contains no triangle");
  }
  return model;
}
}  // namespace altiplan::mesh
