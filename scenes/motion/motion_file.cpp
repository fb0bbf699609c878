#include "scenes/motion/motion_file.h"

#include <cstring>
#include <fstream>
#include <iterator>
#include <type_traits>

#include "core/base/error.h"

namespace cscd::scenes {
namespace {

// Values whose bytes are all there is to them. The structures among them hold doubles alone.
template <class T>
concept Plain = std::is_arithmetic_v<T> || std::is_enum_v<T> || std::is_same_v<T, Vec3> ||
    std::is_same_v<T, Quaternion> || std::is_same_v<T, Transform> || std::is_same_v<T, ScaleTurnMove> ||
    std::is_same_v<T, MorphTarget::Knot>;

class Writer {
 public:
  void bytes(const void* from, std::size_t count) { out_.append(static_cast<const char*>(from), count); }
  std::size_t count(std::size_t count) {
    bytes(&count, sizeof count);
    return count;
  }
  const std::string& written() const { return out_; }

 private:
  std::string out_;
};

class Reader {
 public:
  explicit Reader(std::string text) : text_(std::move(text)) {}
  void bytes(void* to, std::size_t count) {
    if (count > text_.size() - at_) throw InputError("motion: is cut off");
    std::memcpy(to, text_.data() + at_, count);
    at_ += count;
  }
  // Every element takes a byte at least, so that no damaged count asks for more memory than there is text.
  std::size_t count(std::size_t) {
    std::size_t count = 0;
    bytes(&count, sizeof count);
    if (count > text_.size() - at_) throw InputError("motion: a count is damaged");
    return count;
  }
  bool is_at_end() const { return at_ == text_.size(); }

 private:
  std::string text_;
  std::size_t at_ = 0;
};

// The functions below visit the members of a value in a fixed order: a Writer appends them, a Reader sets
// them.
template <class File, Plain T>
void visit(File& file, T& x) {
  file.bytes(&x, sizeof x);
}
template <class File>
void visit(File& file, bool& x) {
  unsigned char byte = x;
  file.bytes(&byte, 1);
  x = byte != 0;
}
template <class File>
void visit(File& file, std::string& x) {
  x.resize(file.count(x.size()));
  file.bytes(x.data(), x.size());
}
template <class File, class T, std::size_t N>
void visit(File& file, std::array<T, N>& list);
template <class File, class T>
void visit(File& file, std::vector<T>& list);
template <class File, class T>
void visit(File& file, std::optional<T>& x);

template <class File, class... Members>
void visit_all(File& file, Members&... members) {
  (visit(file, members), ...);
}

template <class File>
void visit(File& file, FollowedScale& x) {
  visit_all(file, x.node, x.inverse);
}
template <class File>
void visit(File& file, Node& x) {
  visit_all(file, x.name, x.parent, x.local, x.written, x.follows);
}
template <class File>
void visit(File& file, Joint& x) {
  visit_all(file, x.node, x.offset);
}
template <class File>
void visit(File& file, Influence& x) {
  visit_all(file, x.joint, x.weight);
}
template <class File>
void visit(File& file, MorphTarget& x) {
  visit_all(file, x.name, x.displacements, x.weight, x.response);
}
template <class File>
void visit(File& file, Part& x) {
  visit_all(file, x.name, x.node, x.positions, x.triangles, x.joints, x.first, x.influences, x.targets,
            x.dual_quaternion, x.mesh, x.primitive);
}
template <class File, class Value>
void visit(File& file, Key<Value>& x) {
  visit_all(file, x.time, x.value, x.next, x.arriving, x.leaving);
}
template <class File>
void visit(File& file, Extrapolation& x) {
  visit_all(file, x.before, x.after, x.repeats_before, x.repeats_after, x.first, x.last, x.tick);
}
template <class File>
void visit(File& file, Curve& x) {
  visit_all(file, x.keys, x.beyond);
}
template <class File, std::size_t Width>
void visit(File& file, Components<Width>& x) {
  visit_all(file, x.axis, x.rest);
}
template <class File, std::size_t Width>
void visit(File& file, Layer<Width>& x) {
  visit_all(file, x.values, x.blend, x.as_maps, x.weight);
}
template <class File, std::size_t Width>
void visit(File& file, Layered<Width>& x) {
  visit_all(file, x.base, x.above);
}
template <class File>
void visit(File& file, Channel& x) {
  visit_all(file, x.node, x.moves, x.rotations, x.scales, x.move_components, x.scale_components,
            x.angles.degrees, x.angles.order);
}
template <class File>
void visit(File& file, MorphChannel& x) {
  visit_all(file, x.part, x.weights);
}
template <class File>
void visit(File& file, Animation& x) {
  visit_all(file, x.name, x.start, x.seconds, x.ticks_per_second, x.channels, x.morphs, x.layer_weights);
}
template <class File>
void visit(File& file, MovingCharacter& x) {
  visit_all(file, x.character.nodes, x.character.parts, x.character.animations, x.raw_vertex);
}

template <class File, class T, std::size_t N>
void visit(File& file, std::array<T, N>& list) {
  for (T& x : list) visit(file, x);
}
template <class File, class T>
void visit(File& file, std::vector<T>& list) {
  list.resize(file.count(list.size()));
  if constexpr (Plain<T>) {
    if (!list.empty()) file.bytes(list.data(), list.size() * sizeof(T));
  } else {
    for (T& x : list) visit(file, x);
  }
}
template <class File, class T>
void visit(File& file, std::optional<T>& x) {
  bool has = x.has_value();
  visit(file, has);
  if (has && !x) x.emplace();
  if (has) visit(file, *x);
}

}  // namespace

void write_motion(const MovingCharacter& moving, const std::filesystem::path& path) {
  Writer writer;
  MovingCharacter copy = moving;  // the visit takes what a Reader may change
  visit(writer, copy);
  std::ofstream file(path, std::ios::binary);
  file.write(writer.written().data(), static_cast<std::streamsize>(writer.written().size()));
  file.close();
  if (!file) throw InputError("its motion cannot be written; is the disk full?");
}

MovingCharacter read_motion(const std::filesystem::path& path, std::size_t vertices) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw InputError("motion: is missing");
  Reader reader({std::istreambuf_iterator<char>(file), {}});
  MovingCharacter moving;
  visit(reader, moving);
  if (!reader.is_at_end()) throw InputError("motion: has more than a motion");
  validate(moving.character, {});
  std::size_t raw = 0;
  for (const Part& part : moving.character.parts) raw += part.positions.size();
  if (moving.raw_vertex.size() != vertices) throw InputError("motion: does not fit the surface");
  for (const std::int32_t v : moving.raw_vertex)
    if (v < 0 || static_cast<std::size_t>(v) >= raw) throw InputError("motion: does not fit the surface");
  return moving;
}

}  // namespace cscd::scenes
