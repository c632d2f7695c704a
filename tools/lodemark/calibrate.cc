// lodemark calibrate: a camera's lens from photographs of a board.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/camera/board_detection.h"
#include "core/camera/calibration.h"
#include "tools/lodemark/calibration_drawing.h"
#include "tools/lodemark/calibration_text.h"
#include "tools/lodemark/command.h"
#include "tools/lodemark/progress_bar.h"
#include "tools/lodemark/subcommands.h"
#include "tools/lodemark/text_table.h"
#include "tools/photos/photo_file.h"

namespace lodemark {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostReasons = 8;

// Photographs without a board, before any with one, after which something is said, and after which
// only so many of the others are looked at, spread over all: a search that finds nothing takes
// seconds.
constexpr int kMissesToTell = 3;
constexpr int kMissesToStop = 12;
constexpr std::size_t kLastLooks = 4;

struct CalibrateOptions {
  std::vector<std::string> images;
  std::string board;
  std::string square;
  std::string dictionary;
  std::string marker;
  std::string model = "auto";
  std::string out;
  std::string picture;
  bool json = false;
};

Error Usage(const std::string& option, const std::string& text, const char* wanted) {
  return {ErrorCode::kInvalidArgument, option + " " + Printable(text) + ": " + wanted};
}

// "25mm", "2.5cm", "0.025m", "1in", in metres.
Result<double> LengthOf(const std::string& option, const std::string& text) {
  constexpr std::array<std::pair<std::string_view, double>, 4> kUnits = {
      {{"mm", 1e-3}, {"cm", 1e-2}, {"in", 0.0254}, {"m", 1.0}}};
  const char* wanted = "is no length; write it with its unit, like 25mm, 2.5cm, 0.025m or 1in";
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || !std::isfinite(value) || !(value > 0.0)) {
    return Usage(option, text, wanted);
  }
  const std::string_view unit(end, static_cast<std::size_t>(text.data() + text.size() - end));
  for (const auto& [name, metres] : kUnits) {
    if (unit == name) return value * metres;
  }
  return Usage(option, text, wanted);
}

Result<BoardPattern> PatternOf(const CalibrateOptions& options) {
  BoardPattern pattern;
  const char* first = options.board.data();
  const char* last = first + options.board.size();
  const auto columns = std::from_chars(first, last, pattern.columns);
  const bool has_cross = columns.ec == std::errc() && columns.ptr != last && *columns.ptr == 'x';
  const auto rows = has_cross ? std::from_chars(columns.ptr + 1, last, pattern.rows) : columns;
  if (!has_cross || rows.ec != std::errc() || rows.ptr != last) {
    return Usage("--board", options.board,
                 "is no size; write the numbers of inner corners, like 9x6");
  }
  const Result<double> square_m = LengthOf("--square", options.square);
  if (!square_m) return square_m.error();
  pattern.square_m = *square_m;
  if (!options.dictionary.empty()) {
    const Result<double> marker_m = LengthOf("--marker", options.marker);
    if (!marker_m) return marker_m.error();
    pattern.markers = BoardMarkers{options.dictionary, *marker_m};
  }
  const Status status = CheckPattern(pattern);
  if (!status) return status.error();
  return pattern;
}

bool IsPhotoName(const fs::path& path) {
  std::string ending = path.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  for (const char* known : {".jpg", ".jpeg", ".png", ".tif", ".tiff"}) {
    if (ending == known) return true;
  }
  return false;
}

// The files named, and of each folder the photographs in it by name.
Result<std::vector<std::string>> PathsOf(const std::vector<std::string>& named) {
  std::vector<std::string> paths;
  for (const std::string& name : named) {
    std::error_code error;
    const fs::file_status status = fs::status(name, error);
    if (!fs::exists(status)) {
      return Error{ErrorCode::kIo,
                   name + ": no such file or folder; name the photographs of the board"};
    }
    if (!fs::is_directory(status)) {
      paths.push_back(name);
      continue;
    }
    std::vector<std::string> inside;
    for (fs::directory_iterator entry(name, error), end; !error && entry != end;
         entry.increment(error)) {
      if (IsPhotoName(entry->path())) inside.push_back(entry->path().string());
    }
    if (error) return Error{ErrorCode::kIo, name + ": cannot be listed: " + error.message()};
    if (inside.empty()) {
      return Error{ErrorCode::kBadData, name + ": there are no photographs in this folder"};
    }
    std::sort(inside.begin(), inside.end());
    paths.insert(paths.end(), inside.begin(), inside.end());
  }
  return paths;
}

// What may be wrong where no board is found.
class BoardDoubts {
 public:
  explicit BoardDoubts(const BoardPattern& pattern) : pattern_(pattern) {}

  void NoteFound() { are_settled_ = true; }

  // Tells when it is time. The photograph shows no such board.
  void NoteMiss(const GrayImage& image) {
    if (are_settled_) return;
    ++misses_;
    if (misses_ <= kMissesToTell && !pattern_.markers && !shows_smaller_) {
      BoardPattern smaller = pattern_;
      --smaller.columns;
      --smaller.rows;
      shows_smaller_ = CheckPattern(smaller).ok() && FindBoard(image, smaller).has_value();
    }
    if (misses_ == kMissesToTell) Tell();
  }

  bool are_final() const { return !are_settled_ && misses_ >= kMissesToStop; }

 private:
  void Tell() const {
    const int columns = pattern_.columns;
    const int rows = pattern_.rows;
    PrintMessage(Format("none of the first %d photographs shows a board of %d x %d inner corners",
                        misses_, columns, rows));
    if (shows_smaller_) {
      PrintMessage(Format(
          "but one of %d x %d: --board counts the corners inside, one fewer than squares each "
          "way; try --board %dx%d, or count anew: a larger board shows it, too",
          columns - 1, rows - 1, columns - 1, rows - 1));
      return;
    }
    PrintMessage(
        Format("searching on; check that the board has %d x %d squares (--board counts the "
               "corners inside, one fewer each way), is whole and sharp in the photographs, "
               "has a white rim, and %s",
               columns + 1, rows + 1,
               pattern_.markers ? "markers of that dictionary" : "no markers (--charuco)"));
  }

  BoardPattern pattern_;
  int misses_ = 0;
  bool are_settled_ = false;
  bool shows_smaller_ = false;
};

// The photographs with the boards found in them.
struct Album {
  std::vector<CalibrationPhoto> photos;
  std::vector<BoardView> views;  // one a photograph; without corners where none was found
  std::vector<std::array<int, 2>> sizes;
  int readable = 0;
  std::string first_problem;
};

// Whether any of a few photographs from here to the end shows the board; else tells that the search
// ends.
bool ShowsBoardLater(const std::vector<std::string>& paths, std::size_t from,
                     const BoardPattern& pattern) {
  const std::size_t rest = paths.size() - from;
  const std::size_t step = (rest + kLastLooks - 1) / kLastLooks;
  std::size_t looked_at = 0;
  for (std::size_t i = from + step - 1; i < paths.size(); i += step) {
    ++looked_at;
    const Result<Photo> read = ReadPhoto(paths[i]);
    if (!read) continue;
    const GrayImage image = {read->pixels.data(), read->width_px, read->height_px, read->width_px};
    if (FindBoard(image, pattern)) return true;
  }
  PrintMessage(Format("stopped: none of %zu photographs shows the board, %zu were not looked at",
                      from + looked_at, rest - looked_at));
  return false;
}

Album FindBoards(const std::vector<std::string>& paths, const BoardPattern& pattern) {
  Album album;
  BoardDoubts doubts(pattern);
  bool stopped = false;
  ProgressBar progress("Finding boards", StderrIsTerminal());
  for (std::size_t i = 0; i < paths.size(); ++i) {
    progress.Update(static_cast<double>(i) / static_cast<double>(paths.size()));
    CalibrationPhoto photo;
    photo.name = fs::path(paths[i]).filename().string();
    BoardView view;
    std::array<int, 2> size = {};
    if (doubts.are_final() && !stopped) {
      progress.Finish();
      stopped = !ShowsBoardLater(paths, i, pattern);
      if (!stopped) doubts.NoteFound();
    }
    if (stopped) {
      photo.reason = Format("left out, for %zu others show no board", i);
      view.name = photo.name;
      album.photos.push_back(std::move(photo));
      album.views.push_back(std::move(view));
      album.sizes.push_back(size);
      continue;
    }
    const Result<Photo> read = ReadPhoto(paths[i]);
    if (!read) {
      photo.reason = read.error().message.substr(read.error().message.find(": ") + 2);
      if (album.first_problem.empty()) album.first_problem = read.error().message;
    } else {
      ++album.readable;
      size = {read->width_px, read->height_px};
      const GrayImage image = {read->pixels.data(), read->width_px, read->height_px,
                               read->width_px};
      const auto found = FindBoard(image, pattern);
      if (found) {
        view = *found;
        doubts.NoteFound();
      } else {
        progress.Finish();
        doubts.NoteMiss(image);
        photo.reason =
            Format("no board of %d x %d inner corners found", pattern.columns, pattern.rows);
      }
    }
    view.name = photo.name;
    photo.corners = static_cast<int>(view.corners.size());
    album.photos.push_back(std::move(photo));
    album.views.push_back(std::move(view));
    album.sizes.push_back(size);
  }
  return album;
}

// The size that most boards were seen in; the photographs of another size are left out.
std::array<int, 2> KeepOneSize(Album* album) {
  std::map<std::array<int, 2>, int> counts;
  for (std::size_t i = 0; i < album->views.size(); ++i) {
    if (!album->views[i].corners.empty()) ++counts[album->sizes[i]];
  }
  std::array<int, 2> size = {};
  int most = 0;
  for (const auto& [candidate, count] : counts) {
    if (count > most) {
      most = count;
      size = candidate;
    }
  }
  for (std::size_t i = 0; i < album->views.size(); ++i) {
    if (album->views[i].corners.empty() || album->sizes[i] == size) continue;
    album->photos[i].reason = Format("it is %d x %d pixels, the others are %d x %d",
                                     album->sizes[i][0], album->sizes[i][1], size[0], size[1]);
    album->views[i].corners.clear();
  }
  return size;
}

int BoardsIn(const Album& album) {
  return static_cast<int>(
      std::count_if(album.views.begin(), album.views.end(),
                    [](const BoardView& view) { return !view.corners.empty(); }));
}

void PrintReasons(const Album& album) {
  std::size_t count = 0;
  for (const CalibrationPhoto& photo : album.photos) {
    if (photo.is_used || photo.reason.empty()) continue;
    if (++count <= kMostReasons) PrintMessage(Printable(photo.name + ": " + photo.reason));
  }
  if (count > kMostReasons) {
    PrintMessage(Format("and %zu more photographs were not used", count - kMostReasons));
  }
}

LensKind KindOf(const std::string& model) {
  if (model == "pinhole") return LensKind::kPinhole;
  if (model == "brown") return LensKind::kBrown;
  if (model == "fisheye") return LensKind::kFisheye;
  return LensKind::kAuto;
}

bool EndsWithAny(const std::string& path, std::initializer_list<const char*> endings) {
  return std::any_of(endings.begin(), endings.end(),
                     [&](const char* ending) { return path.ends_with(ending); });
}

// Faults of the command line that would otherwise show only after the work.
Status CheckOutputs(const CalibrateOptions& options) {
  if (!options.out.empty() && !EndsWithAny(options.out, {".json", ".yml", ".yaml", ".xml"})) {
    return Usage("--out", options.out, "name a .json, or a .yml or .xml for OpenCV");
  }
  if (!options.picture.empty() && !EndsWithAny(options.picture, {".png", ".jpg", ".jpeg"})) {
    return Usage("--picture", options.picture, "name a .png or .jpg");
  }
  return {};
}

int RunCalibrate(const CalibrateOptions& options) {
  if (const Status status = CheckOutputs(options); !status) return ReportError(status.error());
  const Result<BoardPattern> pattern = PatternOf(options);
  if (!pattern) return ReportError(pattern.error());
  const Result<std::vector<std::string>> paths = PathsOf(options.images);
  if (!paths) return ReportError(paths.error());
  Album album = FindBoards(*paths, *pattern);
  if (album.readable == 0) {
    PrintMessage(album.first_problem);
    return kExitInput;
  }
  const int boards = BoardsIn(album);
  const std::array<int, 2> size = KeepOneSize(&album);

  CalibrationOptions calibrate;
  calibrate.kind = KindOf(options.model);
  Result<Calibration> calibration = Calibrate(size[0], size[1], album.views, calibrate);
  if (!calibration) {
    PrintReasons(album);
    PrintMessage(calibration.error().message);
    return kExitMissed;
  }
  for (std::size_t i = 0; i < album.photos.size(); ++i) {
    const CalibratedView& view = calibration->views[i];
    album.photos[i].is_used = view.is_used;
    album.photos[i].rms_px = view.rms_px;
    if (!view.reason.empty()) album.photos[i].reason = view.reason;
  }
  PrintResult(options.json ? CalibrationJson(*calibration, album.photos)
                           : CalibrationText(*calibration, album.photos, StdoutIsTerminal()));
  FlushResults();
  for (const std::string& warning : calibration->warnings) PrintMessage("warning: " + warning);
  if (2 * boards < album.readable) {
    PrintMessage(
        Format("warning: only %d of %d photographs show a board of %d x %d inner corners: is "
               "--board as it should be?",
               boards, album.readable, pattern->columns, pattern->rows));
  }
  if (!options.out.empty()) {
    const Result<std::string> text = CalibrationFile(*calibration, album.photos, options.out);
    if (!text) return ReportError(text.error());
    if (const Status written = WriteFileWhole(options.out, *text); !written) {
      return ReportError(written.error());
    }
  }
  if (!options.picture.empty()) {
    const Status drawn = DrawCalibration(*calibration, album.views, options.picture);
    if (!drawn) return ReportError(drawn.error());
  }
  return kExitGood;
}

}  // namespace

void AddCalibrateCommand(CLI::App& app, int* exit_code) {
  const auto options = std::make_shared<CalibrateOptions>();
  CLI::App* command =
      app.add_subcommand("calibrate", "A camera's lens from photographs of a chessboard");
  command->add_option("IMAGES", options->images, "Photographs of the board, or folders of them")
      ->required();
  command
      ->add_option("--board", options->board,
                   "Inner corners, one fewer than squares each way: COLUMNSxROWS, like 9x6")
      ->required();
  command->add_option("--square", options->square, "Side of a square, with its unit: 25mm")
      ->required();
  CLI::Option* dictionary =
      command->add_option("--charuco", options->dictionary,
                          "The board has markers of this dictionary: " + KnownDictionaries());
  CLI::Option* marker =
      command->add_option("--marker", options->marker, "Side of a marker, with its unit: 18mm");
  dictionary->needs(marker);
  marker->needs(dictionary);
  command
      ->add_option("--model", options->model,
                   "Kind of lens: auto (default), pinhole, brown, fisheye")
      ->check(CLI::IsMember({"auto", "pinhole", "brown", "fisheye"}));
  command->add_option("--out", options->out,
                      "Write the lens into this camera.json, or OpenCV's .yml or .xml");
  command->add_option("--picture", options->picture,
                      "Draw residuals and coverage into this .png or .jpg");
  command->add_flag("--json", options->json, "Print JSON");
  command->callback([options, exit_code] { *exit_code = RunCalibrate(*options); });
}

}  // namespace lodemark
