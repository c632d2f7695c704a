#include "tools/renderer/facade.h"

#include <algorithm>
#include <cmath>

#include "core/base/random.h"
#include "tools/renderer/lettering.h"
#include "tools/renderer/wall_painting.h"
#include "tools/renderer/window_painting.h"

namespace lodemark {
namespace {

std::uint64_t SeedOf(std::uint64_t a, std::uint64_t b, std::uint64_t c) {
  return (a * 0x9e3779b97f4a7c15ULL + b) * 0xbf58476d1ce4e5b9ULL + c;
}

// A wall being painted. building decides what all walls of it share, layout what stays on this one,
// day the rest.
class FacadePainter {
 public:
  FacadePainter(const FacadeDesign& design, const Daylight& day, double texel_m)
      : design_(design),
        day_light_(day),
        building_(SeedOf(design.building_seed, 1, 0)),
        layout_(SeedOf(design.building_seed, 2, static_cast<std::uint64_t>(design.wall))),
        day_(SeedOf(design.building_seed, 3 + day.seed, static_cast<std::uint64_t>(design.wall))),
        facade_{Canvas(design.width_m, design.height_m, texel_m), {}} {}

  PaintedFacade Paint() {
    tone_ = WallTone(design_.kind, &building_);
    ChooseStyle();
    PaintWall(design_.kind, tone_, &layout_, canvas());
    switch (design_.kind) {
      case FacadeKind::kGlass:
        PaintCurtainWall();
        break;
      case FacadeKind::kConcrete:
        PaintBareWall();
        break;
      case FacadeKind::kBus:
        PaintBus();
        break;
      default:
        PaintFloors();
    }
    if (design_.kind != FacadeKind::kBus) {
      PaintCornice();
      PaintWeather(design_.kind == FacadeKind::kGlass ? 0.12F : 0.3F, &layout_, canvas());
    }
    return std::move(facade_);
  }

 private:
  Canvas* canvas() { return &facade_.canvas; }
  double width_m() const { return design_.width_m; }
  double height_m() const { return design_.height_m; }
  void Note(CanvasPoint point) {
    const bool inside = point.u_m > 0.3 && point.u_m < width_m() - 0.3 && point.v_m > 0.3 &&
                        point.v_m < height_m() - 0.3;
    if (inside) facade_.distinct_points.push_back(point);
  }

  void ChooseStyle() {
    floor_m_ = building_.Uniform(3.1, 3.8);
    ground_floor_m_ = building_.Uniform(3.8, 4.8);
    bay_m_ = building_.Uniform(2.7, 4.4);
    window_across_ = building_.Uniform(0.4, 0.62);
    window_up_ = building_.Uniform(0.45, 0.62);
    style_.frame = building_.Uniform() < 0.65
                       ? Grey(static_cast<float>(building_.Uniform(0.5, 0.8)))
                       : 0.35F * SaturatedColour(&building_);
    style_.panes_across = 1 + static_cast<int>(building_.Index(3));
    style_.panes_up = 1 + static_cast<int>(building_.Index(3));
    style_.arched = design_.kind == FacadeKind::kStone && building_.Uniform() < 0.6;
    style_.shadow_u = design_.sun_slope_u;
    style_.shadow_v = design_.sun_slope_v;
    conditioners_ = building_.Uniform(0.15, 0.5);
    if (design_.kind == FacadeKind::kTiles) conditioners_ *= 0.4;
    balconies_ = design_.kind == FacadeKind::kPlaster ? building_.Uniform(0.0, 0.3) : 0.0;
  }

  void PaintFloors() {
    const int bays = std::max(1, static_cast<int>(width_m() / bay_m_));
    const double bay_m = width_m() / bays;
    const double room_m = height_m() - ground_floor_m_ - 0.8;
    const int floors = std::max(0, static_cast<int>(room_m / floor_m_));
    if (design_.kind == FacadeKind::kStone) PaintBands(floors);
    for (int floor = 0; floor < floors; ++floor) {
      for (int bay = 0; bay < bays; ++bay) {
        PaintBay({bay * bay_m, ground_floor_m_ + floor * floor_m_, (bay + 1) * bay_m,
                  ground_floor_m_ + (floor + 1) * floor_m_});
      }
    }
    PaintGroundFloor(bays, bay_m);
    PaintPipes(bays, bay_m);
    if (design_.kind == FacadeKind::kShops) PaintSignsAbove(bays, bay_m, floors);
    if (design_.kind == FacadeKind::kFoliage) {
      const double leaves = 1.0 - 0.75 * day_light_.winter;
      PaintLeaves({0.0, 0.0, width_m(), 0.92 * height_m()}, 38.0, leaves, &layout_, canvas());
    }
  }

  // One window's piece of wall.
  void PaintBay(const CanvasRect& bay) {
    const bool plain = design_.kind == FacadeKind::kTiles;
    if (!plain && layout_.Uniform() < 0.05) {  // walled up, or never there: a plate instead
      const CanvasPoint at = bay.centre();
      const double radius_m = layout_.Uniform(0.3, 0.5);
      canvas()->FillEllipse(at, radius_m, radius_m, {0.6F * tone_, 0.0F});
      canvas()->FillEllipse(at, 0.55 * radius_m, 0.55 * radius_m, {1.3F * tone_, 0.0F});
      Note(at);
      return;
    }
    const double shift = plain ? 0.0 : layout_.Uniform(-0.015, 0.015);
    const double wide_m = bay.width_m() * window_across_;
    const double high_m = bay.height_m() * window_up_;
    const double left_m = bay.left_m + (0.5 + shift) * bay.width_m() - 0.5 * wide_m;
    const double low_m = bay.low_m + 0.27 * bay.height_m();
    const bool balcony = layout_.Uniform() < balconies_;
    const CanvasRect window = {left_m, balcony ? bay.low_m + 0.2 : low_m, left_m + wide_m,
                               low_m + high_m};
    WindowStyle style = style_;
    if (!plain && layout_.Uniform() < 0.12) {  // somebody put in other ones
      style.frame = Grey(static_cast<float>(layout_.Uniform(0.15, 0.85)));
      style.panes_across = 1 + static_cast<int>(layout_.Index(3));
      style.panes_up = 1 + static_cast<int>(layout_.Index(2));
    }
    style.sill = !balcony;
    PaintWindow(window, style, &layout_, &day_, canvas());
    if (balcony) {
      PaintBalcony({window.left_m - 0.5, window.low_m, window.right_m + 0.5, window.low_m + 1.05},
                   &layout_, &day_, canvas());
    } else if (layout_.Uniform() < conditioners_) {
      const bool below = layout_.Uniform() < 0.6;
      Note(PaintAirConditioner(
          {below ? window.left_m + layout_.Uniform(0.0, 0.4) : window.right_m + 0.15,
           below ? window.low_m - 0.85 : window.low_m + 0.1},
          style, &layout_, canvas()));
    }
  }

  void PaintGroundFloor(int bays, double bay_m) {
    const bool shops = design_.kind == FacadeKind::kShops;
    const double high_m = std::min(ground_floor_m_, 0.9 * height_m());
    if (!shops) {  // a base course
      canvas()->FillRect({0.0, 0.0, width_m(), 0.7}, {0.6F * tone_, 0.0F}, 0.8F);
    }
    for (int bay = 0; bay < bays; ++bay) {
      const CanvasRect piece = {bay * bay_m + 0.15, 0.0, (bay + 1) * bay_m - 0.15, high_m};
      const double kind = layout_.Uniform();
      if (shops) {
        PaintShop(piece);
      } else if (kind < 0.18 && piece.width_m() > 2.0) {
        const double middle_m = piece.centre().u_m;
        Note(PaintDoor({middle_m - 0.8, 0.15, middle_m + 0.8, 2.5}, &layout_, canvas()));
      } else if (kind < 0.45) {
        PaintNotices(piece);
      } else if (kind < 0.9) {
        const double wide_m = piece.width_m() * window_across_;
        const double left_m = piece.centre().u_m - 0.5 * wide_m;
        WindowStyle style = style_;
        style.arched = false;
        PaintWindow({left_m, 1.2, left_m + wide_m, 0.78 * high_m}, style, &layout_, &day_,
                    canvas());
        if (layout_.Uniform() < 0.35) PaintBars({left_m, 1.2, left_m + wide_m, 0.78 * high_m});
      }
    }
  }

  void PaintBars(const CanvasRect& window) {
    for (double u_m = window.left_m; u_m <= window.right_m; u_m += 0.16) {
      canvas()->Stroke({u_m, window.low_m}, {u_m, window.high_m}, 0.025, {Grey(0.2F), 0.0F});
    }
  }

  // Posters, some of which are other ones another day.
  void PaintNotices(const CanvasRect& piece) {
    const int posters = 1 + static_cast<int>(layout_.Index(3));
    for (int i = 0; i < posters; ++i) {
      const double wide_m = layout_.Uniform(0.6, 1.3);
      const double left_m =
          layout_.Uniform(piece.left_m, std::max(piece.left_m + 0.01, piece.right_m - wide_m));
      const double low_m = layout_.Uniform(0.9, 1.7);
      const std::uint64_t own = layout_.NextBits();
      const bool replaced = day_.Uniform() < 0.35;
      Random poster(replaced ? own ^ day_.NextBits() : own);
      PaintPoster({left_m, low_m, left_m + wide_m, low_m + 1.4 * wide_m}, &poster, canvas());
    }
  }

  void PaintShop(const CanvasRect& piece) {
    const double sign_m = layout_.Uniform(0.8, 1.2);
    const CanvasRect front = {piece.left_m, 0.25, piece.right_m, piece.high_m - sign_m - 0.25};
    canvas()->FillRect(front, {Grey(0.04F), 0.6F});
    // Goods behind the glass, rearranged by the day.
    const int goods = 6 + static_cast<int>(layout_.Index(10));
    for (int i = 0; i < goods; ++i) {
      Random* const random = i % 3 == 0 ? &day_ : &layout_;
      const double size_m = random->Uniform(0.1, 0.35);
      const double left_m = random->Uniform(front.left_m, front.right_m - size_m);
      const double low_m = random->Uniform(front.low_m, front.low_m + 0.6 * front.height_m());
      canvas()->FillRect({left_m, low_m, left_m + size_m, low_m + random->Uniform(0.1, 0.5)},
                         {SaturatedColour(random), 0.4F});
    }
    canvas()->FrameRect(front, 0.08, {style_.frame, 0.0F});
    const double middle_m = layout_.Uniform(front.left_m + 0.5, front.right_m - 0.5);
    canvas()->FrameRect({middle_m - 0.5, front.low_m, middle_m + 0.5, front.low_m + 2.2}, 0.07,
                        {style_.frame, 0.0F});
    if (layout_.Uniform() < 0.35) {  // an awning, striped
      const Colour stripe = SaturatedColour(&layout_);
      const double low_m = front.high_m - 0.8;
      int i = 0;
      for (double u_m = front.left_m; u_m < front.right_m; u_m += 0.25, ++i) {
        canvas()->FillRect({u_m, low_m, std::min(u_m + 0.25, front.right_m), front.high_m},
                           {i % 2 == 0 ? stripe : Grey(0.7F), 0.0F});
      }
      canvas()->Shade({front.left_m, low_m - 0.7, front.right_m, low_m}, 0.6F);
    }
    Note(PaintSign({piece.left_m, piece.high_m - sign_m - 0.15, piece.right_m, piece.high_m - 0.15},
                   &layout_, canvas()));
  }

  void PaintSignsAbove(int bays, double bay_m, int floors) {
    for (int bay = 1; bay < bays; ++bay) {
      const double kind = layout_.Uniform();
      const double u_m = bay * bay_m;
      if (kind < 0.35) {  // standing, between the windows
        const double low_m = ground_floor_m_ + layout_.Uniform(0.0, 1.0);
        const double high_m = std::min(low_m + layout_.Uniform(2.5, 5.5), height_m() - 0.5);
        const double half_m = layout_.Uniform(0.3, 0.5);
        Note(PaintSign({u_m - half_m, low_m, u_m + half_m, high_m}, &layout_, canvas()));
      } else if (kind < 0.5 && floors > 1) {
        const double low_m =
            ground_floor_m_ +
            floor_m_ * static_cast<double>(1 + layout_.Index(static_cast<std::uint64_t>(floors))) -
            0.75;
        const double half_m = layout_.Uniform(1.2, 2.6);
        if (low_m + 0.9 < height_m() && u_m - half_m > 0.0 && u_m + half_m < width_m()) {
          Note(PaintSign({u_m - half_m, low_m, u_m + half_m, low_m + 0.9}, &layout_, canvas()));
        }
      }
    }
  }

  // Pilasters and string courses.
  void PaintBands(int floors) {
    for (int floor = 0; floor <= floors; ++floor) {
      const double v_m = ground_floor_m_ + floor * floor_m_;
      canvas()->FillRect({0.0, v_m - 0.16, width_m(), v_m + 0.16}, {1.15F * tone_, 0.0F});
      canvas()->Shade({0.0, v_m - 0.3, width_m(), v_m - 0.16}, 0.6F);
    }
  }

  void PaintPipes(int bays, double bay_m) {
    const auto light = static_cast<float>(layout_.Uniform(0.4, 0.9));
    for (int bay = 0; bay <= bays; bay += 2 + static_cast<int>(layout_.Index(3))) {
      const double u_m = std::clamp(bay * bay_m + layout_.Uniform(-0.3, 0.3), 0.2, width_m() - 0.2);
      canvas()->Shade({u_m + 0.06, 0.0, u_m + 0.16, height_m()}, 0.65F);
      canvas()->FillRect({u_m - 0.06, 0.0, u_m + 0.06, height_m()}, {light * tone_, 0.0F});
      for (double v_m = layout_.Uniform(0.8, 2.0); v_m < height_m(); v_m += 2.2) {
        canvas()->FillRect({u_m - 0.1, v_m, u_m + 0.1, v_m + 0.08}, {0.5F * tone_, 0.0F});
      }
    }
    // A cable that sags from hook to hook.
    double v_m = ground_floor_m_ + layout_.Uniform(-0.2, 0.3);
    for (double u_m = 0.0; u_m < width_m();) {
      const double next_u_m = u_m + layout_.Uniform(1.5, 4.0);
      const double next_v_m = v_m + layout_.Uniform(-0.08, 0.08);
      const CanvasPoint middle = {0.5 * (u_m + next_u_m), 0.5 * (v_m + next_v_m) - 0.12};
      canvas()->Stroke({u_m, v_m}, middle, 0.03, {Grey(0.04F), 0.0F});
      canvas()->Stroke(middle, {next_u_m, next_v_m}, 0.03, {Grey(0.04F), 0.0F});
      u_m = next_u_m;
      v_m = next_v_m;
    }
  }

  void PaintCornice() {
    const double high_m = height_m();
    canvas()->FillRect({0.0, high_m - 0.55, width_m(), high_m}, {1.12F * tone_, 0.0F});
    canvas()->Shade({0.0, high_m - 0.85, width_m(), high_m - 0.55}, 0.62F);
    canvas()->FillRect({0.0, high_m - 0.12, width_m(), high_m}, {Grey(0.25F), 0.0F});
  }

  // Panes in a grid, hardly one like no other.
  void PaintCurtainWall() {
    const double pane_m = building_.Uniform(1.3, 1.8);
    const int across = std::max(1, static_cast<int>(width_m() / pane_m));
    const int up = std::max(1, static_cast<int>(height_m() / 1.9));
    const double wide_m = width_m() / across;
    const double high_m = height_m() / up;
    for (int row = 0; row < up; ++row) {
      for (int column = 0; column < across; ++column) {
        const auto light = static_cast<float>(layout_.Uniform(0.75, 1.25));
        const CanvasRect pane = {column * wide_m, row * high_m, (column + 1) * wide_m,
                                 (row + 1) * high_m};
        canvas()->FillRect(pane, {light * tone_, 0.9F});
        if (layout_.Uniform() < 0.12) {
          const double drop_m = layout_.Uniform(0.2, 1.0) * high_m;
          canvas()->FillRect({pane.left_m, pane.high_m - drop_m, pane.right_m, pane.high_m},
                             {Grey(0.4F), 0.6F});
        }
        canvas()->FrameRect(pane, 0.04, {style_.frame, 0.1F});
      }
    }
  }

  // Formwork holes, and little else.
  void PaintBareWall() {
    for (double v_m = 0.75; v_m < height_m(); v_m += 1.5) {
      for (double u_m = 0.75; u_m < width_m(); u_m += 1.5) {
        canvas()->FillEllipse({u_m, v_m}, 0.04, 0.04, {Grey(0.1F), 0.0F});
      }
    }
    const double doors_m = std::min(0.3 * width_m(), 6.0);
    if (width_m() > 8.0 && height_m() > 3.5) {
      Note(PaintDoor({doors_m, 0.1, doors_m + 1.6, 2.4}, &layout_, canvas()));
    }
  }

  void PaintBus() {
    const Colour livery = SaturatedColour(&building_);
    canvas()->FillRect({0.0, 0.35, width_m(), height_m()}, {livery, 0.1F});
    canvas()->FillRect({0.0, 0.0, width_m(), 0.35}, {Grey(0.02F), 0.0F});
    const int panes = std::max(1, static_cast<int>(width_m() / 1.6));
    const double pane_m = (width_m() - 0.6) / panes;
    for (int i = 0; i < panes; ++i) {
      canvas()->FillRect(
          {0.34 + i * pane_m, 0.52 * height_m(), 0.26 + (i + 1) * pane_m, 0.88 * height_m()},
          {Grey(0.03F), 0.8F});
    }
    if (width_m() > 5.0) {
      for (const double share : {0.2, 0.8}) {
        const CanvasPoint wheel = {share * width_m(), 0.48};
        canvas()->FillEllipse(wheel, 0.5, 0.5, {Grey(0.02F), 0.0F});
        canvas()->FillEllipse(wheel, 0.25, 0.25, {Grey(0.35F), 0.0F});
      }
      PaintWriting({0.3 * width_m(), 0.3 * height_m(), 0.7 * width_m(), 0.45 * height_m()},
                   {Grey(0.85F), 0.0F}, &building_, canvas());
    }
  }

  const FacadeDesign& design_;
  const Daylight& day_light_;
  Random building_;
  Random layout_;
  Random day_;
  PaintedFacade facade_;

  Colour tone_;
  WindowStyle style_;
  double floor_m_ = 3.4;
  double ground_floor_m_ = 4.2;
  double bay_m_ = 3.5;
  double window_across_ = 0.5;
  double window_up_ = 0.5;
  double conditioners_ = 0.3;
  double balconies_ = 0.0;
};

}  // namespace

PaintedFacade PaintFacade(const FacadeDesign& design, const Daylight& day, double texel_m) {
  return FacadePainter(design, day, texel_m).Paint();
}

}  // namespace lodemark
