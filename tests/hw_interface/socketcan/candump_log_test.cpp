#include "hw_interface/socketcan/candump_log.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "hw_interface/socketcan/frame_recorder.hpp"
#include "tests/support/scratch_folder.hpp"

namespace wex::can {
namespace {

class CandumpLog : public ::testing::Test {
 protected:
  void write(const std::string& text) { std::ofstream(file_) << text; }

  ScratchFolder folder_{"candump"};
  std::filesystem::path file_ = folder_ / "log";
};

LoggedFrame frame(std::uint32_t id, std::initializer_list<std::uint8_t> data, bool fd = true) {
  LoggedFrame logged;
  logged.time_ns = 1'700'000'000'123'456'000;
  logged.frame.id = id;
  logged.frame.fd = fd;
  logged.frame.length = static_cast<std::uint8_t>(data.size());
  std::copy(data.begin(), data.end(), logged.frame.data.begin());
  return logged;
}
std::string line_of(const LoggedFrame& logged) {
  std::string text;
  append_line(logged, "vcan0", text);
  return text;
}

TEST_F(CandumpLog, LinesAreAsCandumpWritesThem) {
  EXPECT_EQ(line_of(frame(0x123, {0xDE, 0xAD})), "(1700000000.123456) vcan0 123##1DEAD\n");
  EXPECT_EQ(line_of(frame(0x00A, {0x01}, false)), "(1700000000.123456) vcan0 00A#01\n");
  LoggedFrame logged = frame(0x1ABCDEF0, {}, false);
  logged.frame.extended = true;
  EXPECT_EQ(line_of(logged), "(1700000000.123456) vcan0 1ABCDEF0#\n");
  logged = frame(0x7FF, {}, false);
  logged.frame.remote = true;
  EXPECT_EQ(line_of(logged), "(1700000000.123456) vcan0 7FF#R\n");
  logged = frame(0x40, {0, 0, 0, 0, 0, 0, 0, 0}, false);
  logged.frame.error = true;
  EXPECT_EQ(line_of(logged), "(1700000000.123456) vcan0 20000040#0000000000000000\n");
}

TEST_F(CandumpLog, EveryKindOfFrameIsReadBackAsItWas) {
  for (const bool fd : {true, false}) {
    for (const bool extended : {true, false}) {
      for (const bool error : {true, false}) {
        if ((fd || extended) && error) continue;
        LoggedFrame logged = frame(extended ? 0x1FFFFFFF : 0x7F0, {1, 2, 0xFF, 0}, fd);
        logged.frame.extended = extended;
        logged.frame.error = error;
        std::string line = line_of(logged);
        line.pop_back();
        const auto read = parse_line(line);
        ASSERT_TRUE(read) << line << ": " << read.error();
        EXPECT_EQ(read->time_ns, logged.time_ns);
        EXPECT_EQ(read->frame.id, logged.frame.id);
        EXPECT_EQ(read->frame.fd, fd);
        EXPECT_EQ(read->frame.extended, extended);
        EXPECT_EQ(read->frame.error, error);
        EXPECT_EQ(read->frame.length, 4);
        EXPECT_EQ(read->frame.data, logged.frame.data);
      }
    }
  }
}

TEST_F(CandumpLog, ReadsWhatOtherProgramsWrite) {
  for (const char* line :
       {"(1700000000.123456) can0 123##100ff", "(1700000000.123456) can0 123##000FF R",
        "(1700000000.123456) can0 123#00FF T", "(0.000001) vcan0 7FF#R",
        "(0.000001) vcan0 7FF#R8\r"}) {
    EXPECT_TRUE(parse_line(line)) << line;
  }
}

TEST_F(CandumpLog, RefusesWhatIsNoFrame) {
  for (const char* line :
       {"", "hello", "(1700000000.123456)", "(1700000000.123456) can0", "(170.12) can0 123#00",
        "(x.123456) can0 123#00", "(17000000000000.123456) can0 123#00",
        "(1700000000.123456)  123#00", "(1700000000.123456) can0 123", "(1.000000) can0 1234#00",
        "(1.000000) can0 FFF#00", "(1.000000) can0 12G#00", "(1.000000) can0 123#0",
        "(1.000000) can0 123#0G", "(1.000000) can0 123#000102030405060708", "(1.000000) can0 123##",
        "(1.000000) can0 123##G00", "(1.000000) can0 123#RX"}) {
    EXPECT_FALSE(parse_line(line)) << line;
  }
  std::string long_line = "(1.000000) can0 123##1";
  for (int i = 0; i < 65; ++i) long_line += "00";
  EXPECT_FALSE(parse_line(long_line));
}

TEST_F(CandumpLog, ABadLineIsNamed) {
  write("(1.000000) can0 123#00\n\n(1.000000) can0 123#0\n");
  const auto log = read_candump_log(file_);
  ASSERT_FALSE(log);
  EXPECT_EQ(log.error().code, ErrorCode::kBadInput);
  EXPECT_NE(log.error().message.find("line 3"), std::string::npos) << log.error().message;
}

TEST_F(CandumpLog, AMissingOrEmptyLogIsRefused) {
  EXPECT_FALSE(read_candump_log(file_));
  write("\n");
  EXPECT_FALSE(read_candump_log(file_));
  write("(1.000000) can0 123#00\n");
  const auto log = read_candump_log(file_);
  ASSERT_TRUE(log);
  EXPECT_EQ(log->size(), 1U);
}

TEST_F(CandumpLog, TheRecorderKeepsTheLastFramesInOrder) {
  FrameRecorder recorder({.duration_s = 1.0, .max_frames_per_s = 10.0});
  for (int i = 0; i < 25; ++i) {
    recorder.record(frame(static_cast<std::uint32_t>(i), {}).frame, i * 50'000'000LL);
  }
  EXPECT_EQ(recorder.size(), 11U);
  ASSERT_TRUE(recorder.write(file_, "vcan0"));
  const auto log = read_candump_log(file_);
  ASSERT_TRUE(log);
  ASSERT_EQ(log->size(), 11U);
  for (std::size_t i = 0; i < 11; ++i) EXPECT_EQ((*log)[i].frame.id, 14 + i);
}

TEST_F(CandumpLog, TheRecorderWritesNoMoreThanItsDuration) {
  FrameRecorder recorder({.duration_s = 1.0, .max_frames_per_s = 100.0});
  for (int i = 0; i < 30; ++i) {
    recorder.record(frame(static_cast<std::uint32_t>(i), {}).frame, i * 100'000'000LL);
  }
  ASSERT_TRUE(recorder.write(file_));
  EXPECT_EQ(read_candump_log(file_)->size(), 11U);
}

TEST_F(CandumpLog, AFrozenRecorderKeepsWhatItHas) {
  FrameRecorder recorder({.duration_s = 1.0, .max_frames_per_s = 10.0});
  recorder.record(frame(1, {}).frame, 0);
  recorder.freeze();
  recorder.record(frame(2, {}).frame, 1);
  EXPECT_TRUE(recorder.frozen());
  EXPECT_EQ(recorder.size(), 1U);
  recorder.thaw();
  recorder.record(frame(3, {}).frame, 2);
  EXPECT_EQ(recorder.size(), 2U);
}

TEST_F(CandumpLog, AFileThatCannotBeWrittenIsAnError) {
  const FrameRecorder recorder;
  const auto written = recorder.write("/no/such/folder/x.log");
  ASSERT_FALSE(written);
  EXPECT_EQ(written.error().code, ErrorCode::kBadInput);
}

}  // namespace
}  // namespace wex::can
