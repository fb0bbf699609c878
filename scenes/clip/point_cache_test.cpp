#include "scenes/clip/point_cache.h"

#include <cstdio>
#include <fstream>
#include <gtest/gtest.h>
#include <limits>
#include <set>
#include <unistd.h>

#include "core/base/error.h"
#include "core/base/test_folder.h"
#include "core/base/test_refusal.h"
#include "scenes/base/test_says.h"
#include "scenes/clip/digest.h"
#include "scenes/clip/hdf5_file.h"
#include "scenes/clip/test_clips.h"
#include "scenes/clip/test_hdf5_leaks.h"

namespace cscd::scenes {
namespace {

namespace fs = std::filesystem;

#ifdef __SANITIZE_ADDRESS__
constexpr bool kAddressSanitizer = true;
#else
constexpr bool kAddressSanitizer = false;
#endif

class PointCache : public testing::Test {
 protected:
  ~PointCache() override {
    EXPECT_EQ(H5Fget_obj_count(H5F_OBJ_ALL, H5F_OBJ_ALL), 0) << "all that was opened is closed";
  }

  void write(const SmallClip& what) {
    Clip clip = small_clip(what);
    write(clip, file);
  }
  static void write(Clip& clip, const fs::path& path, bool force = true) {
    PointCacheWriter writer(path, clip.header(), force);
    copy_frames(clip, writer);
    writer.finish();
  }

  // Replaces a dataset of the file by a dataset of another type, shape or content. Without data the dataset
  // is only declared.
  void replace(const char* name, hid_t type, const std::vector<hsize_t>& shape, const void* data,
               hid_t memory_type) {
    const Hdf5Handle h5 = edit();
    H5Ldelete(h5.get(), name, H5P_DEFAULT);
    const Hdf5Handle space(H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr), H5Sclose);
    const Hdf5Handle creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
    if (!data && shape.size() == 3) {
      const hsize_t chunk[3] = {1, std::min<hsize_t>(shape[1], 1 << 20), 3};
      H5Pset_chunk(creation.get(), 3, chunk);
    }
    const Hdf5Handle dataset(
        H5Dcreate2(h5.get(), name, type, space.get(), H5P_DEFAULT, creation.get(), H5P_DEFAULT), H5Dclose);
    ASSERT_TRUE(dataset.valid());
    ASSERT_TRUE(!data || H5Dwrite(dataset.get(), memory_type, H5S_ALL, H5S_ALL, H5P_DEFAULT, data) >= 0);
  }
  void replace(const char* name, hid_t type, const std::vector<hsize_t>& shape,
               const std::vector<double>& data) {
    replace(name, type, shape, data.data(), H5T_NATIVE_DOUBLE);
  }
  void replace(const char* name, hid_t type, const std::vector<hsize_t>& shape,
               const std::vector<std::int64_t>& data) {
    replace(name, type, shape, data.data(), H5T_NATIVE_INT64);
  }
  void declare(const char* name, hid_t type, const std::vector<hsize_t>& shape) {
    replace(name, type, shape, nullptr, H5T_NATIVE_DOUBLE);
  }
  void remove(const char* name) { H5Ldelete(edit().get(), name, H5P_DEFAULT); }
  Hdf5Handle edit() {
    silence_hdf5();
    return {H5Fopen(file.c_str(), H5F_ACC_RDWR, H5P_DEFAULT), H5Fclose};
  }

  // Reads the whole file. Returns the text of the InputError, without the folder, or an empty text.
  std::string refusal() {
    std::string text = test::refusal([&] {
      PointCacheReader reader(file);
      for (std::size_t i = 0; i < reader.interval_count(); ++i) reader.load(i);
    });
    const std::size_t place = text.find(folder.string() + "/");
    if (place != std::string::npos) text.erase(place, folder.string().size() + 1);
    return text;
  }
  std::vector<fs::path> files() const { return {fs::directory_iterator(folder), fs::directory_iterator()}; }
  static std::string bytes(const fs::path& path) { return test::read(path); }

  const test::Folder scratch;
  const fs::path folder = scratch.path, file = folder / "clip.h5";
};

// All combinations of parts that a clip can have.
const SmallClip kKinds[] = {{.frames = 5},
                            {.frames = 5, .bones = 3},
                            {.frames = 5, .predicted = true},
                            {.frames = 5, .bones = 3, .predicted = true}};

TEST_F(PointCache, KeepsWhichAxisPointsUp) {
  write({});
  EXPECT_EQ(PointCacheReader(file).header().up, "");
  ClipHeader header = small_clip({}).header();
  header.up = "-z";
  Clip clip(header);
  Clip frames = small_clip({});
  copy_frames(frames, clip);
  write(clip, file);
  EXPECT_EQ(PointCacheReader(file).header().up, "-z");
}

// Python's h5py writes texts of any length. What is no axis is refused.
TEST_F(PointCache, TakesTheAxisAsATextOfAnyKind) {
  const auto put = [&](const char* text, std::size_t size) {
    write({});
    const Hdf5Handle h5 = edit();
    const Hdf5Handle type(H5Tcopy(H5T_C_S1), H5Tclose), space(H5Screate(H5S_SCALAR), H5Sclose);
    H5Tset_size(type.get(), size);
    H5Tset_cset(type.get(), H5T_CSET_UTF8);
    const Hdf5Handle attribute(H5Acreate2(h5.get(), "up", type.get(), space.get(), H5P_DEFAULT, H5P_DEFAULT),
                               H5Aclose);
    ASSERT_GE(
        H5Awrite(attribute.get(), type.get(), size == H5T_VARIABLE ? static_cast<const void*>(&text) : text),
        0);
  };
  put("x", H5T_VARIABLE);
  EXPECT_EQ(PointCacheReader(file).header().up, "x");
  put("-y", 2);
  EXPECT_EQ(PointCacheReader(file).header().up, "-y");
  const std::string refused = "clip.h5, attribute up: is no axis; write one of the texts x, y, z, -x, -y, -z";
  put("up", H5T_VARIABLE);
  EXPECT_EQ(refusal(), refused);
  put(std::string(3000, 'x').c_str(), 3000);
  EXPECT_EQ(refusal(), refused);
  write({});
  {
    const Hdf5Handle h5 = edit();
    const Hdf5Handle space(H5Screate(H5S_SCALAR), H5Sclose);
    Hdf5Handle(H5Acreate2(h5.get(), "up", H5T_NATIVE_INT, space.get(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  }
  EXPECT_EQ(refusal(), refused);
}

TEST_F(PointCache, GivesBackEveryBit) {
  for (const SmallClip& kind : kKinds) {
    Clip clip = small_clip(kind);
    write(clip, file);
    PointCacheReader reader(file);
    EXPECT_EQ(reader.header().triangles, clip.header().triangles);
    EXPECT_EQ(reader.header().vertex_count, clip.header().vertex_count);
    EXPECT_EQ(reader.header().bone_parent, clip.header().bone_parent);
    EXPECT_EQ(reader.header().predicted, kind.predicted);
    ASSERT_EQ(reader.frame_count(), 5u);
    for (const std::size_t i : {0, 1, 2, 3, 0, 2, 1, 1, 3}) {
      const ClipInterval read = reader.load(i), written = clip.interval(i);
      const auto same = [](std::span<const Vec3> a, std::span<const Vec3> b) {
        return std::ranges::equal(a, b);
      };
      EXPECT_TRUE(same(read.motion.start(), written.motion.start())) << i;
      EXPECT_TRUE(same(read.motion.end(), written.motion.end())) << i;
      ASSERT_EQ(read.bones.has_value(), kind.bones > 0);
      for (std::size_t b = 0; b < kind.bones; ++b) {
        EXPECT_EQ(read.bones->start[b].head, written.bones->start[b].head);
        EXPECT_EQ(read.bones->end[b].tail, written.bones->end[b].tail);
      }
    }
    DigestSink direct, through;
    copy_frames(clip, direct);
    Clip whole = read_clip(file);
    copy_frames(whole, through);
    EXPECT_EQ(direct.text(), through.text());
  }
}

TEST_F(PointCache, HasTheSameBytesWheneverItIsWritten) {
  for (const SmallClip& kind : kKinds) {
    write(kind);
    const std::string once = bytes(file);
    sleep(kind.bones && kind.predicted ? 1 : 0);  // would change a time of creation, which is in seconds
    write(kind);
    EXPECT_EQ(once, bytes(file));
  }
}

TEST_F(PointCache, AcceptsOtherTypesWhereNothingIsLost) {
  write({});
  std::vector<double> positions;
  for (int i = 0; i < 24; ++i) positions.push_back(0.125 * i);
  replace("/positions", H5T_IEEE_F32BE, {2, 4, 3}, positions);
  replace("/triangles", H5T_STD_I64BE, {4, 3}, std::vector<std::int64_t>{0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3});
  EXPECT_EQ(refusal(), "");
  PointCacheReader reader(file);
  EXPECT_EQ(reader.load(0).motion.end()[3], Vec3(2.625, 2.75, 2.875));
}

TEST_F(PointCache, RefusesWhatIsNotHdf5) {
  EXPECT_EQ(refusal(), "clip.h5: no such file; check the name");
  std::ofstream(file) << "not a point cache";
  EXPECT_EQ(refusal(),
            "clip.h5: is not a readable HDF5 file (cut short, damaged, or of another kind); write it again");
  fs::remove(file);
  fs::create_directory(file);
  EXPECT_EQ(refusal(), "clip.h5: is not a file; give a point cache");
}

TEST_F(PointCache, RefusesEveryTruncation) {
  write({.frames = 3, .bones = 2, .predicted = true});
  const std::string whole = bytes(file);
  for (std::size_t length = 0; length < whole.size(); length += whole.size() / 61 + 1) {
    std::ofstream(file, std::ios::binary | std::ios::trunc) << whole.substr(0, length);
    EXPECT_NE(refusal(), "") << "cut to " << length << " of " << whole.size() << " bytes";
  }
}

TEST_F(PointCache, SurvivesFlippedBytes) {
  write({.frames = 3, .bones = 2, .predicted = true});
  const std::string whole = bytes(file);
  for (std::size_t at = 0; at < whole.size(); at += 61) {
    std::string damaged = whole;
    damaged[at] = static_cast<char>(~damaged[at]);
    std::ofstream(file, std::ios::binary | std::ios::trunc) << damaged;
    refusal();  // may refuse the file or read it, but must not crash
  }
}

TEST_F(PointCache, NamesTheMissingDataset) {
  write({.frames = 3, .bones = 2, .predicted = true});
  const std::string bytes_before = bytes(file);
  for (const char* name : {"/positions", "/triangles", "/bones/parent", "/bones/head", "/bones/tail",
                           "/bones/predicted_head", "/bones/predicted_tail"}) {
    std::ofstream(file, std::ios::binary | std::ios::trunc) << bytes_before;
    remove(name);
    EXPECT_EQ(refusal(), "clip.h5, " + std::string(name) +
                             ": dataset is missing; write it as the point cache format says");
  }
}

TEST_F(PointCache, RefusesOtherTypesRanksAndShapes) {
  const std::vector<double> zeros(1000, 0.0);
  const auto refused = [&](const char* name, hid_t type, const std::vector<hsize_t>& shape) {
    write({.frames = 3, .bones = 2, .predicted = true});
    replace(name, type, shape, zeros);
    return refusal();
  };
  EXPECT_EQ(refused("/positions", H5T_STD_I32LE, {3, 4, 3}),
            "clip.h5, /positions: has elements of another type; write float64");
  EXPECT_EQ(refused("/positions", H5T_NATIVE_LDOUBLE, {3, 4, 3}),
            "clip.h5, /positions: has elements of another type; write float64");
  EXPECT_EQ(refused("/triangles", H5T_IEEE_F64LE, {4, 3}),
            "clip.h5, /triangles: has elements of another type; write int32");
  EXPECT_EQ(refused("/positions", H5T_IEEE_F64LE, {12, 3}),
            "clip.h5, /positions: has 2 dimensions; it needs 3");
  EXPECT_EQ(refused("/positions", H5T_IEEE_F64LE, {3, 4, 2}),
            "clip.h5, /positions: has shape [3, 4, 2]; its last extent must be 3");
  EXPECT_EQ(refused("/triangles", H5T_STD_I32LE, {3, 4}),
            "clip.h5, /triangles: has shape [3, 4]; its last extent must be 3");
  EXPECT_EQ(refused("/positions", H5T_IEEE_F64LE, {1, 4, 3}),
            "clip.h5, /positions: has 1 frames; an interval needs at least 2");
  EXPECT_EQ(refused("/predicted", H5T_IEEE_F64LE, {2, 5, 3}),
            "clip.h5, /predicted: has shape [2, 5, 3], but /positions asks for [2, 4, 3]");
  EXPECT_EQ(refused("/predicted", H5T_IEEE_F64LE, {3, 4, 3}),
            "clip.h5, /predicted: has shape [3, 4, 3], but /positions asks for [2, 4, 3]");
  EXPECT_EQ(refused("/bones/tail", H5T_IEEE_F64LE, {3, 1, 3}),
            "clip.h5, /bones/tail: has shape [3, 1, 3], but /positions and /bones/parent asks for [3, 2, 3]");
}

TEST_F(PointCache, RefusesIndicesOutOfRange) {
  for (const std::int64_t corner : {std::int64_t{4}, std::int64_t{-1}, std::int64_t{1} << 40}) {
    write({.frames = 2, .bones = 2});
    replace("/triangles", H5T_STD_I64LE, {2, 3}, std::vector<std::int64_t>{0, 1, 2, 1, corner, 3});
    EXPECT_EQ(refusal(), "clip.h5, /triangles, triangle 1: corner " + std::to_string(corner) +
                             " is outside [0, 4); /positions has that many vertices");
  }
  replace("/triangles", H5T_STD_I32LE, {1, 3}, std::vector<std::int64_t>{0, 1, 2});
  replace("/bones/parent", H5T_STD_I32LE, {2}, std::vector<std::int64_t>{-1, 2});
  EXPECT_EQ(refusal(), "clip.h5, /bones/parent, bone 1: parent 2 is outside [-1, 2); -1 marks a root");
  replace("/bones/parent", H5T_STD_I32LE, {2}, std::vector<std::int64_t>{1, 0});
  EXPECT_EQ(refusal(), "clip.h5, /bones: rig: bone 0 is its own ancestor; parents must form a tree");
}

TEST_F(PointCache, KeepsThePoseAtRest) {
  const Clip plain = small_clip({.frames = 3});
  ClipHeader header = plain.header();
  for (std::size_t v = 0; v < header.vertex_count; ++v) header.rest.push_back(frame_position(7, v));
  Clip clip(header);
  for (std::size_t i = 0; i < 3; ++i) clip.append(plain.frame(i));
  write(clip, file);
  EXPECT_EQ(PointCacheReader(file).header().rest, header.rest);
  write({.frames = 3});
  EXPECT_TRUE(PointCacheReader(file).header().rest.empty());

  const auto refusal = [&](const std::vector<hsize_t>& shape, const std::vector<double>& data) {
    write({.frames = 3});
    replace("/rest", H5T_IEEE_F64LE, shape, data);
    return test::refusal([&] { PointCacheReader reader(file); });
  };
  EXPECT_EQ(refusal({4, 3}, std::vector<double>(12, 1)), "");
  EXPECT_TRUE(says(refusal({3, 3}, std::vector<double>(9, 1)), "/rest"));
  EXPECT_TRUE(says(refusal({4, 3}, std::vector<double>(12, std::nan(""))), "/rest"));
}

TEST_F(PointCache, NamesFrameAndVertexThatAreNotFinite) {
  write({.frames = 3, .bones = 1});
  std::vector<double> positions(36, 0.5);
  positions[24 + 3 * 3 + 1] = std::numeric_limits<double>::quiet_NaN();
  replace("/positions", H5T_IEEE_F64LE, {3, 4, 3}, positions);
  EXPECT_EQ(refusal(),
            "clip.h5, /positions, frame 2, vertex 3: position is not finite; repair the animation");
  positions[33] = positions[34] = 0;
  replace("/positions", H5T_IEEE_F64LE, {3, 4, 3}, positions);
  std::vector<double> joints(9, 0.5);
  joints[4] = std::numeric_limits<double>::infinity();
  replace("/bones/tail", H5T_IEEE_F64LE, {3, 1, 3}, joints);
  EXPECT_EQ(refusal(), "clip.h5, /bones/tail, frame 1, bone 0: position is not finite; repair the animation");
}

TEST_F(PointCache, RefusesDeclaredSizesThatNothingStandsBehind) {
  write({});
  declare("/positions", H5T_IEEE_F64LE, {2, hsize_t{1} << 27, 3});
  EXPECT_TRUE(says(refusal(), "stores too little for it"));
  declare("/positions", H5T_IEEE_F64LE, {2, hsize_t{1} << 40, 3});
  EXPECT_TRUE(says(refusal(), "from 3 to 2^28 vertices"));
  declare("/positions", H5T_IEEE_F64LE, {2, 0, 3});
  EXPECT_NE(refusal(), "");
  write({});
  declare("/triangles", H5T_STD_I32LE, {hsize_t{1} << 27, 3});
  EXPECT_TRUE(says(refusal(), "stores too little for it"));
  declare("/triangles", H5T_STD_I32LE, {hsize_t{1} << 50, 3});
  EXPECT_TRUE(says(refusal(), "from 1 to 2^28 triangles"));
}

TEST_F(PointCache, RefusesDataThatLieInOtherFiles) {
  write({});
  fs::rename(file, folder / "other.h5");
  write({});
  {
    const Hdf5Handle h5 = edit();
    H5Ldelete(h5.get(), "/positions", H5P_DEFAULT);
    H5Lcreate_external("other.h5", "/positions", h5.get(), "/positions", H5P_DEFAULT, H5P_DEFAULT);
  }
  EXPECT_EQ(refusal(), "clip.h5, /positions: its data lie in another file; store them in this one");
}

TEST_F(PointCache, KnowsItsLastInterval) {
  write({.frames = 3});
  PointCacheReader reader(file);
  EXPECT_NO_THROW(reader.load(1));
  EXPECT_THROW(reader.load(2), InputError);
  EXPECT_NO_THROW(reader.load_frame(2));
  EXPECT_THROW(reader.load_frame(3), InputError);
}

std::string write_refusal(const fs::path& path, bool force) {
  return test::refusal([&] {
    Clip clip = small_clip({});
    PointCacheWriter writer(path, clip.header(), force);
    copy_frames(clip, writer);
    writer.finish();
  });
}

TEST_F(PointCache, OverwritesOnlyWhenAsked) {
  std::ofstream(file) << "precious";
  EXPECT_TRUE(says(write_refusal(file, false), "exists; choose another name"));
  EXPECT_EQ(bytes(file), "precious");
  EXPECT_EQ(write_refusal(file, true), "");
  EXPECT_EQ(refusal(), "");
  EXPECT_EQ(files().size(), 1u) << "no temporary stays";
}

TEST_F(PointCache, AppearsWholeOrNotAtAll) {
  Clip clip = small_clip({.frames = 2});
  {
    PointCacheWriter writer(file, clip.header(), false);
    writer.append(clip.frame(0));
    EXPECT_FALSE(fs::exists(file));
    EXPECT_EQ(files().size(), 1u) << "written beside its final place";
    EXPECT_THROW(writer.finish(), InputError) << "one frame is no interval";
    std::vector<Vec3> bad(4, Vec3::Zero());
    bad[1].x() = std::numeric_limits<double>::quiet_NaN();
    const FrameView frame{bad, {}};
    EXPECT_EQ(test::refusal([&] { writer.append(frame); }),
              file.string() + ", frame 1, vertex 1: position is not finite; repair the animation");
  }
  EXPECT_TRUE(files().empty());
  PointCacheWriter late(file, clip.header(), false);
  copy_frames(clip, late);
  std::ofstream(file) << "came first";
  EXPECT_THROW(late.finish(), InputError);
  EXPECT_EQ(bytes(file), "came first");
}

TEST_F(PointCache, SaysWhereItCannotWrite) {
  EXPECT_TRUE(says(write_refusal(folder / "no" / "such.h5", false), "cannot be created"));
  EXPECT_TRUE(says(write_refusal(folder, true), "is a folder"));
  EXPECT_TRUE(says(write_refusal("/proc/clip.h5", false), "cannot be created"));
  EXPECT_TRUE(files().empty());
}

// The largest memory of this process since the last call of forget_peak, in MiB.
double peak_mebibytes() {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);)
    if (line.starts_with("VmHWM:")) return std::atof(line.c_str() + 6) / 1024;
  return 0;
}
void forget_peak() {
  std::ofstream("/proc/self/clear_refs") << 5;
}

TEST_F(PointCache, StreamsWithTwoFramesInMemory) {
  ClipHeader header = small_clip({}).header();
  header.vertex_count = 100000;
  constexpr std::size_t frames = 80;  // 183 MiB
  std::vector<Vec3> positions(header.vertex_count);
  forget_peak();
  const double before = peak_mebibytes();
  {
    PointCacheWriter writer(file, header, false);
    for (std::size_t frame = 0; frame < frames; ++frame) {
      for (std::size_t i = 0; i < positions.size(); ++i) positions[i] = frame_position(frame, i);
      writer.append({positions, {}});
    }
    writer.finish();
  }
  ASSERT_GT(fs::file_size(file), frames * header.vertex_count * sizeof(Vec3));
  PointCacheReader reader(file);
  std::set<const Vec3*> buffers;
  for (std::size_t i = 0; i < reader.interval_count(); ++i) {
    const ClipInterval interval = reader.load(i);
    buffers.insert({interval.motion.start().data(), interval.motion.end().data()});
    ASSERT_EQ(interval.motion.end()[99999], frame_position(i + 1, 99999));
  }
  EXPECT_EQ(buffers.size(), 2u);
  // AddressSanitizer keeps freed memory, so the limit does not hold there.
  const double growth = peak_mebibytes() - before;
  EXPECT_TRUE(growth < 30 || kAddressSanitizer) << growth << " MiB for a cache of 183 MiB";
}

TEST_F(PointCache, OpensSequencesFarLargerThanMemory) {
  write({});
  constexpr hsize_t frames = 50000, vertices = 24000;
  declare("/positions", H5T_IEEE_F64LE, {frames, vertices, 3});
  const std::vector<Vec3> positions(vertices, Vec3(1, 2, 3));
  {
    const Hdf5Handle h5 = edit();
    const Hdf5Handle dataset(H5Dopen2(h5.get(), "/positions", H5P_DEFAULT), H5Dclose);
    const Hdf5Handle space(H5Dget_space(dataset.get()), H5Sclose);
    const hsize_t start[3] = {frames - 1, 0, 0}, count[3] = {1, vertices, 3};
    H5Sselect_hyperslab(space.get(), H5S_SELECT_SET, start, nullptr, count, nullptr);
    const Hdf5Handle memory(H5Screate_simple(3, count, nullptr), H5Sclose);
    ASSERT_GE(
        H5Dwrite(dataset.get(), H5T_NATIVE_DOUBLE, memory.get(), space.get(), H5P_DEFAULT, positions.data()),
        0);
  }
  PointCacheReader reader(file);  // 26.8 GiB declared
  EXPECT_EQ(reader.frame_count(), frames);
  EXPECT_EQ(reader.load(25000).motion.start()[7], Vec3::Zero());
  EXPECT_EQ(reader.load(frames - 2).motion.end()[vertices - 1], Vec3(1, 2, 3));
}

}  // namespace
}  // namespace cscd::scenes
