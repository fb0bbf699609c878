#include <ctime>

#include "core/base/test_refusal.h"
#include "scenes/character/test_gltf.h"
#include "scenes/import/gltf/test_files.h"

// Checks containers, buffers, extensions and other members that concern the file as a whole.
namespace cscd::scenes::gltf {
namespace {

std::string told(const TestFolder& folder, const std::string& name, const std::string& contents) {
  return test::refusal([&] {
    Character character = read_gltf(folder.write(name, contents), {});
    validate(character, {});
  });
}

// The tube with its buffer at another place.
std::string with_uri(const std::string& uri, std::size_t extra_length = 0) {
  TubeFile file;
  file.root["buffers"] = {{{"byteLength", file.bytes.size() + extra_length}, {"uri", uri}}};
  return file.root.dump();
}

TEST(GltfDocument, BuffersMayLieInTheTextOrBesideTheFile) {
  const TestFolder folder;
  const std::string bytes = TubeFile().bytes;
  folder.write("tube 1+2%.bin", bytes + "more than the file says");
  std::filesystem::create_directories(folder.path / "data");
  folder.write("data/tube.bin", bytes);
  for (const std::string& uri :
       {std::string("tube%201+2%25.bin"), std::string("./data/../tube 1+2%.bin"),
        std::string("data/tube.bin"), "data:application/octet-stream;base64," + base64(bytes),
        "data:;base64," + base64(bytes), "data:application/gltf-buffer;charset=x;base64," + base64(bytes)})
    EXPECT_EQ(told(folder, "test.gltf", with_uri(uri)), "") << uri.substr(0, 50);
  std::string encoded = "data:application/octet-stream,";
  for (const char c : bytes) {
    char digits[4];
    std::snprintf(digits, sizeof digits, "%%%02X", static_cast<unsigned char>(c));
    encoded += digits;
  }
  EXPECT_EQ(told(folder, "test.gltf", with_uri(encoded)), "");
  // A .glb file may have the name of a .gltf file, and a .gltf file that of a .glb file.
  EXPECT_EQ(told(folder, "test.gltf", TubeFile().glb()), "");
  EXPECT_EQ(told(folder, "test.glb", with_uri("data/tube.bin")), "");
}

TEST(GltfDocument, OnlyFilesOfTheModelsOwnFolderAreRead) {
  const TestFolder folder;
  std::filesystem::create_directories(folder.path / "inner");
  folder.write("secret.bin", TubeFile().bytes);
  std::filesystem::create_symlink("../secret.bin", folder.path / "inner" / "link.bin");
  for (const std::string uri :
       {"../secret.bin", "%2e%2e/secret.bin", "link.bin", "none.bin", "/dev/zero", "."})
    EXPECT_TRUE(says(told(folder, "inner/test.gltf", with_uri(uri)), "there is no file")) << uri;
  EXPECT_TRUE(says(told(folder, "test.gltf", with_uri("https://example.org/a.bin")), "only files beside"));
  EXPECT_TRUE(says(told(folder, "test.gltf", with_uri("file:///etc/passwd")), "only files beside"));
}

// The model and its buffers share one limit.
TEST(GltfDocument, FilesTogetherMustNotBeTooLarge) {
  const TestFolder folder;
  const std::string text = with_uri("tube.bin"), bytes = TubeFile().bytes;
  folder.write("tube.bin", bytes);
  const std::filesystem::path file = folder.write("test.gltf", text);
  CharacterLimits limits;
  limits.file_bytes = text.size() + bytes.size();
  EXPECT_NO_THROW(read_gltf(file, limits));
  for (const std::size_t less : {std::size_t{1}, bytes.size() + 1}) {
    limits.file_bytes = text.size() + bytes.size() - less;
    EXPECT_THROW(read_gltf(file, limits), InputError);
  }
}

TEST(GltfDocument, BuffersThatHoldTooLittleAreRefused) {
  const TestFolder folder;
  const std::string bytes = TubeFile().bytes;
  folder.write("tube.bin", bytes);
  const std::string digits = base64(bytes);
  for (const std::string& text :
       {with_uri("tube.bin", 1), with_uri("data:;base64," + digits, 4),
        with_uri("data:;base64," + digits.substr(0, 400) + "?" + digits.substr(401)),
        with_uri("data:;base64,"), with_uri("data:;base64,====")})
    EXPECT_TRUE(says(told(folder, "test.gltf", text), "bytes, but has")) << text.substr(0, 90);
  EXPECT_TRUE(says(told(folder, "test.gltf", with_uri("data:;base64")), "has no comma"));
  TubeFile none;
  none.root["buffers"] = {{{"byteLength", 10}}};
  EXPECT_TRUE(says(told(folder, "test.gltf", none.root.dump()), "neither a uri nor"));
}

TEST(GltfDocument, OtherVersionsAreRefusedAsSuch) {
  TubeFile one, later, unsaid;
  one.root["asset"]["version"] = "1.0";
  EXPECT_TRUE(says(refusal(one), "is a file of glTF 1.0; only glTF 2 is read"));
  later.root["asset"]["minVersion"] = "2.1";
  EXPECT_TRUE(says(refusal(later), "needs a reader of glTF 2.1"));
  unsaid.root.erase("asset");
  EXPECT_TRUE(says(refusal(unsaid), "names no version"));
  std::string binary = TubeFile().glb();
  binary[4] = 1;
  EXPECT_TRUE(says(told(TestFolder(), "test.glb", binary), "is a file of glTF 1; only"));
}

TEST(GltfDocument, EveryTruncationOfABinaryFileIsRefused) {
  const TestFolder folder;
  const std::string whole = TubeFile().glb();
  ASSERT_EQ(told(folder, "test.glb", whole), "");
  for (std::size_t size = 0; size < whole.size(); size += size < 64 ? 1 : 97)
    EXPECT_NE(told(folder, "test.glb", whole.substr(0, size)), "") << size;
}

TEST(GltfDocument, ChunksMustFitTheFile) {
  const TestFolder folder;
  const std::string whole = TubeFile().glb();
  const auto spoiled = [&](std::size_t at, std::uint32_t value) {
    std::string file = whole;
    std::memcpy(file.data() + at, &value, sizeof value);
    return told(folder, "test.glb", file);
  };
  EXPECT_TRUE(says(spoiled(8, 0xffffffff), "says that it has 4294967295 bytes"));
  EXPECT_TRUE(says(spoiled(8, 4), "says that it has 4 bytes"));
  EXPECT_TRUE(says(spoiled(12, 0xfffffff0), "longer than the file"));
  EXPECT_TRUE(says(spoiled(16, 0x004E4942), "does not begin with"));
  // Zeros instead of spaces after the JSON text are accepted.
  std::string zeros = whole;
  const std::size_t end = 20 + static_cast<std::size_t>(static_cast<unsigned char>(whole[12])) +
                          256 * static_cast<std::size_t>(static_cast<unsigned char>(whole[13]));
  for (std::size_t i = end; zeros[i - 1] == ' '; --i) zeros[i - 1] = '\0';
  EXPECT_EQ(told(folder, "test.glb", zeros), "");
}

TEST(GltfDocument, TextThatIsNoGltfIsRefused) {
  const TestFolder folder;
  std::string deep = R"({"asset":{"version":"2.0","extras":)";
  for (int i = 0; i < 100'000; ++i) deep += '[';
  EXPECT_TRUE(says(told(folder, "test.gltf", deep), "nests deeper"));
  EXPECT_TRUE(says(told(folder, "test.gltf", ""), "JSON is damaged"));
  EXPECT_TRUE(says(told(folder, "test.gltf", "Kaydara FBX Binary"), "whatever its name says"));
  EXPECT_TRUE(says(told(folder, "test.gltf", "[]"), "is no object"));
  EXPECT_TRUE(says(told(folder, "test.gltf", R"({"asset":{"version":"2.0"},"scene":1e999})"), "damaged"));
  // A byte order mark is accepted.
  EXPECT_EQ(told(folder, "test.gltf", "\xEF\xBB\xBF" + with_uri("data:;base64," + base64(TubeFile().bytes))),
            "");
  // Brackets within strings do not nest.
  TubeFile file;
  file.root["nodes"][0]["name"] = std::string(200, '[') + "\"" + std::string(200, '{');
  EXPECT_EQ(refusal(file), "");
}

// The time for a list of many objects must not grow with the square of its length.
TEST(GltfDocument, LongListsAreReadInTime) {
  TubeFile file;
  for (int i = 0; i < 200'000; ++i) file.root["materials"].push_back({{"name", "m"}});
  const std::clock_t start = std::clock();  // processor time: others may use the machine too
  EXPECT_EQ(refusal(file), "");
  EXPECT_LT(std::clock() - start, 10 * CLOCKS_PER_SEC);
}

TEST(GltfDocument, RequiredExtensionsAreReadHarmlessOrRefusedByName) {
  TubeFile file;
  file.root["extensionsRequired"] = {"KHR_texture_transform", "KHR_materials_unlit", "KHR_texture_basisu"};
  EXPECT_EQ(refusal(file), "");
  file.root["extensionsRequired"].push_back("VENDOR_bent_space");
  EXPECT_TRUE(says(refusal(file), "'VENDOR_bent_space'"));
  file.root["extensionsRequired"] = {7};
  EXPECT_TRUE(says(refusal(file), "extensionsRequired"));
}

TEST(GltfDocument, OptionalExtensionsThatMayMoveVerticesAreNoted) {
  TubeFile file;
  file.root["extensionsUsed"] = {"EXT_mesh_gpu_instancing", "KHR_lights_punctual", "KHR_materials_clearcoat"};
  // An extension that the file uses without listing it.
  file.root["nodes"][1]["extensions"]["KHR_node_visibility"]["visible"] = false;
  const Character character = read(file);
  EXPECT_TRUE(has_note(character, "'EXT_mesh_gpu_instancing' is not read"));
  EXPECT_TRUE(has_note(character, "'KHR_node_visibility' is not read"));
  EXPECT_EQ(character.notes.size(), 2u);
  file.root["extensionsUsed"].clear();
  for (int i = 0; i < 100; ++i) file.root["extensionsUsed"].push_back("VENDOR_" + std::to_string(i));
  EXPECT_TRUE(has_note(read(file), "81 more optional glTF extensions"));
}

// Damaged images, huge textures and the like do not matter here.
TEST(GltfDocument, TexturesAreNotLookedAt) {
  TubeFile file;
  file.root["images"] = {{{"uri", "../../none.png"}}, {{"bufferView", 999}, {"mimeType", "image/png"}}, 7};
  file.root["textures"] = "none";
  EXPECT_EQ(refusal(file), "");
}

}  // namespace
}  // namespace cscd::scenes::gltf
