#include "scenes/import/read_model.h"

#include <algorithm>
#include <array>
#include <assimp/BaseImporter.h>
#include <assimp/IOStream.hpp>
#include <assimp/Importer.hpp>
#include <assimp/config.h>
#include <assimp/importerdesc.h>
#include <assimp/scene.h>
#include <cmath>
#include <cstring>
#include <limits>
#include <map>
#include <memory>
#include <new>
#include <set>
#include <span>
#include <string_view>

#include "core/base/error.h"
#include "scenes/import/collada/checked.h"
#include "scenes/import/fbx/read_fbx.h"
#include "scenes/import/file_system.h"
#include "scenes/import/gltf/read_gltf.h"
#include "scenes/import/surface.h"
#include "scenes/import/x_text.h"
#include "scenes/polygon/cut_polygon.h"

namespace cscd::scenes {
namespace {

// The formats, with the names of assimp's importers. glTF and FBX are read without assimp.
struct Format {
  std::string_view extension, importer, name;
};
constexpr std::array kFormats = {
    Format{".glb", "", "glTF 2"},
    Format{".gltf", "", "glTF 2"},
    Format{".fbx", "", "FBX"},
    Format{".dae", "Collada Importer", "Collada"},
    Format{".x", "Direct3D XFile Importer", "DirectX X"},
    Format{".bvh", "BVH Importer (MoCap)", "BVH"},
};

// assimp reports 0 ticks a second where the file does not say; its own viewer takes 25 then.
constexpr double kTicksWhereUnsaid = 25;

const Format& format_of(const std::filesystem::path& path) {
  std::string extension = path.extension().string(), known;
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  for (const Format& format : kFormats) {
    if (extension == format.extension) return format;
    if (format.extension == ".bvh") continue;  // holds bones alone
    known += (known.empty() ? "" : ", ") + std::string(format.extension);
  }
  const std::string why = extension.empty()
                              ? "has no extension, by which its format is known; give it its own, one of "
                              : "files of the kind '" + extension + "' are not read; convert it to one of ";
  throw InputError(why + known + ", or .h5, .obj, .ply, .pc2 or .mdd");
}

void keep_only(Assimp::Importer& importer, std::string_view name) {
  for (std::size_t i = importer.GetImporterCount(); i-- > 0;)
    if (importer.GetImporterInfo(i)->mName != name) {
      const std::unique_ptr<Assimp::BaseImporter> ours(importer.GetImporter(i));  // ours once unregistered
      importer.UnregisterLoader(ours.get());
    }
}

std::string text(const aiString& string) {
  return {string.data, std::min<std::size_t>(string.length, sizeof string.data - 1)};
}

Vec3 vector(const aiVector3D& v) {
  return {static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)};
}

Transform transform(const aiMatrix4x4& m) {
  const auto column = [](ai_real x, ai_real y, ai_real z) { return vector(aiVector3D(x, y, z)); };
  return {{column(m.a1, m.b1, m.c1), column(m.a2, m.b2, m.c2), column(m.a3, m.b3, m.c3)},
          column(m.a4, m.b4, m.c4)};
}

class Reader {
 public:
  Reader(const aiScene& scene, const Format& format, const CharacterLimits& limits)
      : scene_(scene), bones_have_nodes_(format.name == "Collada"), limits_(limits) {}

  Character read() {
    if (scene_.mRootNode == nullptr) throw InputError("has no nodes; export it again");
    read_nodes();
    for (std::size_t n = 0; n < source_.size(); ++n)
      for (unsigned i = 0; i < source_[n]->mNumMeshes; ++i)
        read_part(static_cast<int>(n), source_[n]->mMeshes[i]);
    for (unsigned i = 0; i < scene_.mNumAnimations; ++i) read_animation(*scene_.mAnimations[i]);
    note(lines_, "points and lines left out");
    note(overlapping_, kOverlapping);
    note(morphs_, "blend shapes not applied");
    note(again_, "meshes that several nodes share taken once, as their joints place them");
    note(strangers_, "animation channels name no node of the file and are ignored");
    note(dropped_keys_, "keys ignored that repeat the key before");
    note(many_, "weights not positive or without a bone ignored");
    return std::move(character_);
  }

 private:
  void note(std::size_t count, const char* what) {
    if (count > 0) character_.notes.push_back(std::to_string(count) + " " + what);
  }

  // Walks the nodes depth first without recursion: a file may nest deeper than the stack allows.
  void read_nodes() {
    std::vector<std::pair<const aiNode*, int>> open{{scene_.mRootNode, -1}};
    while (!open.empty()) {
      const auto [node, parent] = open.back();
      open.pop_back();
      if (character_.nodes.size() >= limits_.nodes)
        throw InputError("has more than " + std::to_string(limits_.nodes) + " nodes; simplify the model");
      const int index = static_cast<int>(source_.size());
      character_.nodes.push_back({text(node->mName), parent, transform(node->mTransformation)});
      source_.push_back(node);
      if (!by_name_.try_emplace(text(node->mName), index).second) twice_.insert(text(node->mName));
      for (unsigned i = node->mNumChildren; i-- > 0;) open.emplace_back(node->mChildren[i], index);
    }
  }

  // assimp refers to nodes by name alone, so two nodes with one name cannot be told apart.
  void require_one(const std::string& name, const char* what) const {
    if (twice_.contains(name))
      throw InputError(std::string(what) + " '" + name + "': two nodes have this name; rename one of them");
  }

  void read_part(int node, unsigned mesh_index) {
    if (mesh_index >= scene_.mNumMeshes)
      throw InputError("a node names a mesh that does not exist; repair it");
    const aiMesh& mesh = *scene_.mMeshes[mesh_index];
    morphs_ += mesh.mNumAnimMeshes;
    if (mesh.mNumBones > 0 && !skinned_.try_emplace(mesh_index, node).second) {
      ++again_;
      return;
    }
    Part part;
    part.name = text(mesh.mName);
    part.node = node;
    vertices_ += mesh.mNumVertices;
    if (vertices_ > limits_.vertices)
      throw InputError("has more than " + std::to_string(limits_.vertices) + " vertices; simplify the model");
    for (unsigned v = 0; v < mesh.mNumVertices; ++v) part.positions.push_back(vector(mesh.mVertices[v]));
    for (unsigned f = 0; f < mesh.mNumFaces; ++f) add_face(mesh, f, part);
    read_joints(mesh, part);
    character_.parts.push_back(std::move(part));
  }

  void add_face(const aiMesh& mesh, unsigned index, Part& part) {
    const std::span<const unsigned> written(mesh.mFaces[index].mIndices, mesh.mFaces[index].mNumIndices);
    if (written.size() < 3) {
      ++lines_;
      return;
    }
    const std::string where = "mesh '" + part.name + "', face " + std::to_string(index);
    std::vector<std::int32_t> corners;
    for (const unsigned corner : written) {
      if (corner >= mesh.mNumVertices)
        throw InputError(where + ": names a vertex that does not exist; repair it");
      corners.push_back(static_cast<std::int32_t>(corner));
    }
    const PolygonCut cut = cut_polygon(corners, part.positions, part.triangles);
    if (cut == PolygonCut::none)
      throw InputError(where + ": its " + std::to_string(corners.size()) +
                       " corners cannot be cut into triangles; triangulate the mesh before the export");
    overlapping_ += cut == PolygonCut::overlapping;
  }

  void read_joints(const aiMesh& mesh, Part& part) {
    std::vector<std::size_t> count(mesh.mNumVertices + std::size_t{1}, 0);
    std::vector<double> sum(mesh.mNumVertices, 0);
    struct Entry {
      std::size_t vertex;
      Influence influence;
    };
    std::vector<Entry> entries;
    for (unsigned b = 0; b < mesh.mNumBones; ++b) {
      const aiBone& bone = *mesh.mBones[b];
      require_one(text(bone.mName), "bone");
      const auto found = by_name_.find(text(bone.mName));
      if (found == by_name_.end()) {
        // DirectX files of real exporters have such bones, so those get a note.
        if (bones_have_nodes_ && bone.mNumWeights > 0)
          throw InputError("bone '" + text(bone.mName) +
                           "': has weights, and no node has this name; repair it or export the file again");
        many_ += bone.mNumWeights;
        continue;
      }
      const int joint = static_cast<int>(part.joints.size());
      part.joints.push_back({found->second, transform(bone.mOffsetMatrix)});
      for (unsigned w = 0; w < bone.mNumWeights; ++w) {
        const aiVertexWeight& weight = bone.mWeights[w];
        if (weight.mVertexId >= mesh.mNumVertices)
          throw InputError("bone '" + text(bone.mName) + "': weighs a vertex that does not exist; repair it");
        const auto value = static_cast<double>(weight.mWeight);
        if (!std::isfinite(value))
          throw InputError("bone '" + text(bone.mName) + "': a weight is not a number; repair it");
        if (value < 0) ++many_;
        if (!(value > 0)) continue;
        ++count[weight.mVertexId + std::size_t{1}];
        sum[weight.mVertexId] += value;
        entries.push_back({weight.mVertexId, {joint, value}});
      }
    }
    for (std::size_t v = 0; v < mesh.mNumVertices; ++v) count[v + 1] += count[v];
    part.first = count;
    part.influences.resize(entries.size());
    for (const Entry& entry : entries)
      part.influences[count[entry.vertex]++] = {entry.influence.joint,
                                                entry.influence.weight / sum[entry.vertex]};
  }

  template <class AiKey, class Value, class Convert>
  void read_keys(const AiKey* from, unsigned count, double seconds_per_tick, std::vector<Key<Value>>& to,
                 const Convert& convert) {
    keys_ += count;
    if (keys_ > limits_.keys)
      throw InputError("has more than " + std::to_string(limits_.keys) + " animation keys; resample it");
    for (unsigned i = 0; i < count; ++i) {
      const double time = from[i].mTime * seconds_per_tick;
      if (!std::isfinite(time)) throw InputError("an animation key's time is not a number; repair it");
      const Value value = convert(from[i].mValue);
      if (to.empty() || time > to.back().time)
        to.push_back({time, value});
      else if (time < to.back().time || !(from[i].mValue == from[i - 1].mValue))
        throw InputError(
            "an animation key is not later than the key before, and has another value; sort the "
            "keys, and export it again");
      else
        ++dropped_keys_;
    }
  }

  void read_animation(const aiAnimation& source) {
    Animation animation;
    animation.name = text(source.mName);
    animation.ticks_per_second = source.mTicksPerSecond > 0 ? source.mTicksPerSecond : 0;
    const double tick = 1 / (source.mTicksPerSecond > 0 ? source.mTicksPerSecond : kTicksWhereUnsaid);
    double first = std::numeric_limits<double>::infinity(), last = -first;
    for (unsigned c = 0; c < source.mNumChannels; ++c) {
      const aiNodeAnim& channel = *source.mChannels[c];
      require_one(text(channel.mNodeName), "animated node");
      const auto found = by_name_.find(text(channel.mNodeName));
      if (found == by_name_.end()) {
        ++strangers_;
        continue;
      }
      Channel to{found->second, {}, {}, {}};
      read_keys(channel.mPositionKeys, channel.mNumPositionKeys, tick, to.moves, vector);
      read_keys(channel.mRotationKeys, channel.mNumRotationKeys, tick, to.rotations,
                [](const aiQuaternion& q) {
                  return normalised({static_cast<double>(q.w), static_cast<double>(q.x),
                                     static_cast<double>(q.y), static_cast<double>(q.z)});
                });
      read_keys(channel.mScalingKeys, channel.mNumScalingKeys, tick, to.scales, vector);
      // A single key holds at all times, so it does not bear on the length. assimp adds a single key at
      // time 0 for what a channel leaves out.
      const auto reach = [&](const auto& keys) {
        if (keys.size() < 2) return;
        first = std::min(first, keys.front().time);
        last = std::max(last, keys.back().time);
      };
      reach(to.moves);
      reach(to.rotations);
      reach(to.scales);
      animation.channels.push_back(std::move(to));
    }
    // The keys give the clip's start and length, because importers differ in where they
    // begin to count the duration.
    animation.start = first <= last ? first : 0;
    animation.seconds = first <= last ? last - first : 0;
    character_.animations.push_back(std::move(animation));
  }

  const aiScene& scene_;
  const bool bones_have_nodes_;
  const CharacterLimits& limits_;
  Character character_;
  std::vector<const aiNode*> source_;    // [nodes]
  std::map<std::string, int> by_name_;   // the first of equal names
  std::set<std::string> twice_;          // names that two nodes have
  std::map<unsigned, int> skinned_;      // meshes with joints that already have a part
  std::size_t vertices_ = 0, keys_ = 0;  // counts so far
  std::size_t lines_ = 0, overlapping_ = 0, morphs_ = 0, again_ = 0, strangers_ = 0, dropped_keys_ = 0,
              many_ = 0;
};

std::string bytes_of(const std::filesystem::path& path, const CharacterLimits& limits) {
  FolderFiles files(path, limits.file_bytes);
  Assimp::IOStream* file = files.Open(path.c_str(), "rb");
  if (file == nullptr)
    throw InputError("cannot be read as a file of at most " + std::to_string(limits.file_bytes >> 20) +
                     " MiB; check its name and its size");
  std::string bytes(file->FileSize(), '\0');
  bytes.resize(file->Read(bytes.data(), 1, bytes.size()));
  files.Close(file);
  return bytes;
}

// A file as assimp is to read it, and notes on it.
struct CheckedFile {
  std::string bytes;
  std::vector<std::string> notes;
};

CheckedFile checked_file(const Format& format, std::string bytes) {
  if (format.name == "Collada") {
    CheckedCollada checked = checked_collada(bytes);
    if (checked.loose_vertices > 0) checked.notes.push_back(note_on_loose_vertices(checked.loose_vertices));
    return {std::move(checked.xml), std::move(checked.notes)};
  }
  if (format.name == "DirectX X") {
    const CheckedX checked = checked_x(bytes);
    CheckedFile file{std::string(checked.bytes), {}};
    if (checked.loose_vertices > 0) file.notes.push_back(note_on_loose_vertices(checked.loose_vertices));
    return file;
  }
  return {std::move(bytes), {}};
}

}  // namespace

Character read_model(const std::filesystem::path& path, const CharacterLimits& limits) {
  const Format& format = format_of(path);
  if (format.importer.empty()) {
    Character character =
        format.name == "FBX" ? read_fbx(bytes_of(path, limits), limits) : read_gltf(path, limits);
    validate(character, limits);
    return character;
  }
  Assimp::Importer importer;
  keep_only(importer, format.importer);
  importer.SetIOHandler(new FolderFiles(path, limits.file_bytes));  // the importer owns it
  importer.SetPropertyBool(AI_CONFIG_IMPORT_NO_SKELETON_MESHES, true);
  // No further step of assimp runs. Polygons are cut as everywhere in this project, vertices are welded by
  // position (assimp's own step keeps seams of normals and textures open), all weights of a vertex are kept
  // (assimp can limit them to four), and validate() makes the checks.
  const CheckedFile file = checked_file(format, bytes_of(path, limits));
  const aiScene* scene =
      importer.ReadFileFromMemory(file.bytes.data(), file.bytes.size(), 0, &format.extension[1]);
  const std::string_view error = importer.GetErrorString();
  if (error.find("bad_alloc") != error.npos) throw std::bad_alloc();
  if (scene == nullptr)
    throw InputError(std::string("the ") + std::string(format.name) +
                     " importer refuses it: " + std::string(error) + "; export it again");
  Character character = Reader(*scene, format, limits).read();
  character.format = format.name;
  if (format.name == "Collada") {
    character.up = "y";                    // to which assimp turns what the file calls up
    character.centimetres_per_unit = 100;  // assimp scales what the file calls a unit to a metre
  }
  character.notes.insert(character.notes.end(), file.notes.begin(), file.notes.end());
  validate(character, limits);
  return character;
}

}  // namespace cscd::scenes
