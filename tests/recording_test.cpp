// SPDX-License-Identifier: MIT
// Recordings: what is read has the bits that were written, and whatever is not a whole recording is refused.
#include <array>
#include <bit>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <random>

#include <gtest/gtest.h>
#include <unistd.h>

#include <talus/recording.h>

namespace talus {
namespace {

namespace fs = std::filesystem;
using Frames = std::vector<std::vector<Pose>>;

RecordingHeader two_bodies() {
    RecordingHeader header{"stack:height=1", 1.0f / 60.0f, {}};
    header.bodies.push_back({"ground", BodyKind::Static, Box{{20.0f, 1.0f, 30.0f}}});
    header.bodies.push_back({"kügelchen \"1\"", BodyKind::Kinematic, Sphere{0.25f}});
    return header;
}

/// Poses that fall and turn, and numbers that no simulation should make.
Frames some_frames(std::size_t count) {
    std::mt19937 random(5);
    const auto any_float = [&] { return std::bit_cast<float>(static_cast<std::uint32_t>(random())); };
    Frames frames;
    for (std::size_t i = 0; i < count; ++i) {
        const float t = static_cast<float>(i) / 60.0f;
        Pose falling{{0.0f, 10.0f - 4.9f * t * t, -0.0f}, {0.0f, 0.1f * t, 0.0f, 1.0f}};
        Pose odd{{any_float(), std::numeric_limits<float>::infinity(), 1e-42f},
                 {any_float(), 0.0f, std::numeric_limits<float>::quiet_NaN(), 1.0f}};
        frames.push_back({falling, odd});
    }
    return frames;
}

bool same_bits(const Frames& a, const Frames& b) {
    using Words = std::array<std::uint32_t, 7>;
    if (a.size() != b.size()) return false;
    for (std::size_t i = 0; i < a.size(); ++i) {
        if (a[i].size() != b[i].size()) return false;
        for (std::size_t j = 0; j < a[i].size(); ++j)
            if (std::bit_cast<Words>(a[i][j]) != std::bit_cast<Words>(b[i][j])) return false;
    }
    return true;
}

class Recording : public testing::Test {
protected:
    Recording() { fs::create_directories(folder); }
    ~Recording() override { fs::remove_all(folder); }

    void write(const fs::path& path, const Frames& frames) {
        RecordingWriter writer(path, two_bodies());
        for (const std::vector<Pose>& frame : frames)
            writer.write(frame);
        writer.finish();
    }
    Frames read(const fs::path& path) {
        RecordingReader reader(path);
        Frames frames;
        for (std::vector<Pose> frame = reader.next(); !frame.empty(); frame = reader.next())
            frames.push_back(frame);
        EXPECT_EQ(frames.size(), reader.frame_count());
        return frames;
    }
    std::string bytes_of(const fs::path& path) {
        std::ifstream input(path, std::ios::binary);
        return {std::istreambuf_iterator<char>(input), {}};
    }
    void put(const fs::path& path, const std::string& bytes) { std::ofstream(path, std::ios::binary) << bytes; }
    std::string refusal_of(const fs::path& path) {
        try {
            read(path);
        } catch (const Error& error) {
            return error.what();
        }
        return "not refused";
    }
    std::size_t files_in_folder() const {
        return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
    }

    const fs::path folder = fs::path(testing::TempDir()) / ("talus recording " + std::to_string(getpid()));
    const fs::path file = folder / "a.rec";
};

TEST_F(Recording, gives_back_every_bit) {
    const Frames frames = some_frames(150); // more than two stretches between key frames
    write(file, frames);
    EXPECT_TRUE(same_bits(read(file), frames));

    const RecordingReader reader(file);
    const RecordingHeader expected = two_bodies();
    EXPECT_EQ(reader.frame_count(), 150u);
    EXPECT_EQ(reader.header().scene, expected.scene);
    EXPECT_EQ(reader.header().dt, expected.dt);
    ASSERT_EQ(reader.header().bodies.size(), 2u);
    EXPECT_EQ(reader.header().bodies[1].name, expected.bodies[1].name);
    EXPECT_EQ(reader.header().bodies[1].kind, BodyKind::Kinematic);
    EXPECT_EQ(std::get<Box>(reader.header().bodies[0].shape).size, (Vec3{20.0f, 1.0f, 30.0f}));
    EXPECT_EQ(std::get<Sphere>(reader.header().bodies[1].shape).radius, 0.25f);
}

TEST_F(Recording, may_have_no_frames) {
    write(file, {});
    EXPECT_TRUE(read(file).empty());
}

TEST_F(Recording, resting_bodies_take_little_room) {
    write(file, Frames(600, some_frames(1)[0]));
    EXPECT_LT(fs::file_size(file), 600u * 2 * sizeof(Pose));
}

TEST_F(Recording, appears_only_when_finished) {
    put(file, "older");
    {
        RecordingWriter writer(file, two_bodies());
        writer.write(some_frames(1)[0]);
        EXPECT_EQ(bytes_of(file), "older");
    }
    EXPECT_EQ(bytes_of(file), "older");
    EXPECT_EQ(files_in_folder(), 1u);
    write(file, some_frames(1));
    EXPECT_EQ(files_in_folder(), 1u);
    EXPECT_EQ(read(file).size(), 1u);
}

TEST_F(Recording, refuses_a_frame_of_another_size) {
    RecordingWriter writer(file, two_bodies());
    EXPECT_THROW(writer.write(std::vector<Pose>(3)), Error);
    writer.write(std::vector<Pose>(2));
    writer.finish();
    EXPECT_THROW(writer.write(std::vector<Pose>(2)), Error);
    EXPECT_EQ(read(file).size(), 1u);
}

TEST_F(Recording, cannot_be_written_where_there_is_no_folder) {
    EXPECT_THROW(RecordingWriter(folder / "none" / "a.rec", two_bodies()), Error);
    EXPECT_THROW(RecordingWriter(folder, two_bodies()), Error);
}

TEST_F(Recording, every_cut_is_refused) {
    write(file, some_frames(5));
    const std::string whole = bytes_of(file);
    for (std::size_t size = 0; size < whole.size(); ++size) {
        put(file, whole.substr(0, size));
        EXPECT_NE(refusal_of(file), "not refused") << size << " of " << whole.size() << " bytes";
    }
}

TEST_F(Recording, every_damaged_byte_is_refused_or_harmless) {
    const Frames frames = some_frames(5);
    write(file, frames);
    const std::string whole = bytes_of(file);
    std::size_t refused = 0;
    for (std::size_t i = 0; i < whole.size(); ++i) {
        std::string damaged = whole;
        damaged[i] = static_cast<char>(damaged[i] ^ 0x24);
        put(file, damaged);
        try {
            EXPECT_TRUE(same_bits(read(file), frames)) << "byte " << i;
        } catch (const Error&) {
            ++refused;
        }
    }
    EXPECT_GT(refused, whole.size() * 9 / 10);
}

TEST_F(Recording, refusals_say_why) {
    write(file, some_frames(5));
    std::string bytes = bytes_of(file);
    EXPECT_NE(refusal_of(folder / "none.rec").find("no such file"), std::string::npos);
    put(file, "PNG, perhaps");
    EXPECT_NE(refusal_of(file).find("not a Talus recording"), std::string::npos);
    put(file, bytes.substr(0, bytes.size() - 1));
    EXPECT_NE(refusal_of(file).find("ends early"), std::string::npos);
    bytes[8] = 9;
    put(file, bytes);
    EXPECT_NE(refusal_of(file).find("version 9"), std::string::npos);
}

} // namespace
} // namespace talus
