#include "tools/renderer/scene_renderer.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/base/units.h"
#include "tools/renderer/cards.h"
#include "tools/renderer/facade.h"
#include "tools/renderer/lattice_noise.h"

namespace lodemark {
namespace {

constexpr int kTile_px = 16;
constexpr int kSamplesAcross = 2;  // in each pixel, each way
constexpr double kFinestTexel_m = 0.01;
constexpr double kCoarsestTexel_m = 0.08;
constexpr double kMostTexels = 8e6;
constexpr double kHaze_m = 2'500.0;
constexpr double kBusLength_m = 11.5;
constexpr double kBusWidth_m = 2.5;
constexpr double kBusHeight_m = 3.1;
constexpr double kTreeCards = 3;

// What a glossy surface shows: the sky above, the town across below.
Colour Reflected(const LightLevels& levels, const Eigen::Vector3d& direction) {
  const double azimuth_rad = std::atan2(direction.x(), direction.y());
  const auto block = static_cast<std::int32_t>(std::floor(azimuth_rad * 9.0));
  const float roof = 0.12F + 0.3F * CellNumber(block, 1, 11U);
  const auto rise = static_cast<float>(direction.z());
  const Colour sky = 1.5F * levels.sky + 0.2F * levels.sun;
  const Colour town = 0.35F * levels.sky + 0.2F * levels.sun;
  return Mix(town, sky, SmoothStep(roof - 0.05F, roof + 0.05F, rise));
}

std::vector<Upright> TreeCards(const Tree& tree) {
  std::vector<Upright> cards;
  for (int i = 0; i < static_cast<int>(kTreeCards); ++i) {
    const double turn_rad = kPi * i / kTreeCards + 0.1 * static_cast<double>(tree.seed % 31);
    Upright card;
    card.along = {std::sin(turn_rad), std::cos(turn_rad)};
    card.width_m = 0.8 * tree.height_m;
    card.height_m = tree.height_m;
    card.foot = tree.at_m - 0.5 * card.width_m * card.along;
    cards.push_back(card);
  }
  return cards;
}

Building BusAt(const PasserBy& bus) {
  const Eigen::Vector2d ahead(std::sin(bus.heading_rad), std::cos(bus.heading_rad));
  const Eigen::Vector2d left(-ahead.y(), ahead.x());
  Building building;
  for (const auto& [forward, aside] :
       {std::pair{0.5, -0.5}, std::pair{0.5, 0.5}, std::pair{-0.5, 0.5}, std::pair{-0.5, -0.5}}) {
    building.footprint_m.push_back(bus.at_m + forward * kBusLength_m * ahead +
                                   aside * kBusWidth_m * left);
  }
  building.base_m = 0.1;
  building.height_m = kBusHeight_m;
  building.facade = FacadeKind::kBus;
  building.seed = bus.seed;
  return building;
}

}  // namespace

// A wall or a card, and its looks once somebody looked.
struct SceneRenderer::Surface {
  enum class Kind : std::uint8_t { kWall, kTree, kPerson };
  Kind kind = Kind::kWall;
  Upright upright;
  Eigen::Vector3d normal = Eigen::Vector3d::UnitX();
  FacadeKind facade = FacadeKind::kPlaster;
  std::uint64_t seed = 1;
  std::size_t building = 0;
  int wall = 0;
  std::unique_ptr<Texture> texture;
  std::vector<CanvasPoint> distinct_points;

  static std::unique_ptr<Surface> Of(const Upright& upright, Kind kind, std::uint64_t seed) {
    auto surface = std::make_unique<Surface>();
    surface->kind = kind;
    surface->upright = upright;
    const Eigen::Vector2d flat = upright.normal();
    surface->normal = {flat.x(), flat.y(), 0.0};
    surface->seed = seed;
    return surface;
  }
};

// A ray through part of a pixel, and how it changes over that part.
struct SceneRenderer::Sample {
  Ray ray;
  Eigen::Vector3d by_x = Eigen::Vector3d::Zero();
  Eigen::Vector3d by_y = Eigen::Vector3d::Zero();

  Texture::Footprint On(const Surface& surface, double way) const {
    const Eigen::Vector3d along(surface.upright.along.x(), surface.upright.along.y(), 0.0);
    const double against = ray.direction.dot(surface.normal);
    const Eigen::Vector3d x = way * (by_x - by_x.dot(surface.normal) / against * ray.direction);
    const Eigen::Vector3d y = way * (by_y - by_y.dot(surface.normal) / against * ray.direction);
    return {x.dot(along), x.z(), y.dot(along), y.z()};
  }
};

// One photograph being made.
class SceneRenderer::Frame {
 public:
  Frame(SceneRenderer* renderer, const Rigid3& camera_from_enu,
        const std::vector<PasserBy>& passers_by)
      : renderer_(renderer),
        enu_from_camera_(camera_from_enu.rotation().conjugate().toRotationMatrix()),
        centre_m_(camera_from_enu.Inverse().translation()) {
    for (const std::unique_ptr<Surface>& surface : renderer->surfaces_) {
      all_.push_back(surface.get());
    }
    for (const Building& building : renderer->scene_.buildings) roofs_.push_back(&building);
    for (const PasserBy& passer_by : passers_by) Add(passer_by);
  }

  void RenderTile(const ViewRays& rays, int left_px, int top_px, LightImage* image) {
    const int right_px = std::min(left_px + kTile_px, rays.width_px());
    const int bottom_px = std::min(top_px + kTile_px, rays.height_px());
    ChooseNear(rays, left_px, top_px, right_px, bottom_px);
    for (int y_px = top_px; y_px < bottom_px; ++y_px) {
      for (int x_px = left_px; x_px < right_px; ++x_px) {
        const PixelRay pixel = rays.At(x_px, y_px);
        if (!(pixel.direction.squaredNorm() > 0.0)) continue;
        image->pixels[static_cast<std::size_t>(y_px) * static_cast<std::size_t>(image->width_px) +
                      static_cast<std::size_t>(x_px)] = LightOf(pixel);
      }
    }
  }

 private:
  void Add(const PasserBy& passer_by) {
    if (passer_by.kind == PasserBy::Kind::kBus) {
      const Building bus = BusAt(passer_by);
      int number = 0;
      for (const Upright& wall : WallsOf(bus)) {
        own_.push_back(Surface::Of(wall, Surface::Kind::kWall, bus.seed));
        own_.back()->facade = FacadeKind::kBus;
        own_.back()->wall = number++;
        all_.push_back(own_.back().get());
      }
      return;
    }
    Upright card;
    const Eigen::Vector2d to = passer_by.at_m - centre_m_.head<2>();
    if (!(to.norm() > 0.5)) return;
    // Its normal looks back at the camera.
    card.along = Eigen::Vector2d(to.y(), -to.x()).normalized();
    card.width_m = 0.8;
    card.height_m = 1.85;
    card.foot = passer_by.at_m - 0.5 * card.width_m * card.along;
    own_.push_back(Surface::Of(card, Surface::Kind::kPerson, passer_by.seed));
    all_.push_back(own_.back().get());
  }

  // The surfaces that rays of a tile may meet.
  void ChooseNear(const ViewRays& rays, int left_px, int top_px, int right_px, int bottom_px) {
    std::array<Eigen::Vector3d, 9> directions;
    std::size_t count = 0;
    for (const int y_px : {top_px, (top_px + bottom_px) / 2, bottom_px - 1}) {
      for (const int x_px : {left_px, (left_px + right_px) / 2, right_px - 1}) {
        const PixelRay pixel = rays.At(x_px, y_px);
        if (pixel.direction.squaredNorm() > 0.0) {
          directions[count++] = enu_from_camera_ * pixel.direction;
        }
      }
    }
    walls_.clear();
    cards_.clear();
    if (count == 0) {
      for (Surface* surface : all_) Choose(surface);
      return;
    }
    ViewCone cone = ConeAround({directions.data(), count});
    // A pixel's own width, and the bulge of the tile's edges.
    cone.half_angle_rad = 1.05 * cone.half_angle_rad + 2.0 * rays.pixel_angle_rad();
    for (Surface* surface : all_) {
      if (cone.MayMeet(centre_m_, surface->upright.centre(), surface->upright.radius_m())) {
        Choose(surface);
      }
    }
  }

  void Choose(Surface* surface) {
    if (surface->kind != Surface::Kind::kWall) return cards_.push_back(surface);
    const Eigen::Vector2d to = surface->upright.foot - centre_m_.head<2>();
    if (to.dot(surface->upright.normal()) < 0.0) walls_.push_back(surface);
  }

  Colour LightOf(const PixelRay& pixel) {
    const Eigen::Vector3d direction = enu_from_camera_ * pixel.direction;
    const Eigen::Vector3d by_x = enu_from_camera_ * pixel.by_x;
    const Eigen::Vector3d by_y = enu_from_camera_ * pixel.by_y;
    constexpr float kShare = 1.0F / (kSamplesAcross * kSamplesAcross);
    Colour sum;
    for (int i = 0; i < kSamplesAcross; ++i) {
      for (int k = 0; k < kSamplesAcross; ++k) {
        const double x = (i + 0.5) / kSamplesAcross - 0.5;
        const double y = (k + 0.5) / kSamplesAcross - 0.5;
        Sample sample;
        sample.ray = {centre_m_, direction + x * by_x + y * by_y};
        sample.by_x = by_x / kSamplesAcross;
        sample.by_y = by_y / kSamplesAcross;
        sum += kShare * Trace(sample);
      }
    }
    return sum;
  }

  Colour Trace(const Sample& sample) {
    // The nearest thing that hides what is behind it.
    double way = std::numeric_limits<double>::infinity();
    Surface* wall = nullptr;
    UprightHit wall_hit;
    for (Surface* candidate : walls_) {
      const std::optional<UprightHit> hit = Meet(sample.ray, candidate->upright, Sides::kFront);
      if (!hit || hit->way >= way) continue;
      way = hit->way;
      wall = candidate;
      wall_hit = *hit;
    }
    const Eigen::Vector3d& d = sample.ray.direction;
    const bool down = d.z() < 0.0 && centre_m_.z() > 0.0;
    bool flat = false;
    if (down && -centre_m_.z() / d.z() < way) {
      way = -centre_m_.z() / d.z();
      flat = true;
      wall = nullptr;
    }
    bool roof = false;
    for (const Building* building : roofs_) {
      if (centre_m_.z() <= building->base_m + building->height_m) continue;
      const std::optional<double> met = MeetRoof(sample.ray, *building);
      if (!met || *met >= way) continue;
      way = *met;
      roof = true;
      wall = nullptr;
    }
    Colour light;
    if (wall != nullptr) {
      light = Hazed(WallLight(sample, wall, wall_hit), way * d.norm());
    } else if (roof) {
      light = Hazed(0.2F * (renderer_->levels_.sun + renderer_->levels_.sky), way * d.norm());
    } else if (flat) {
      light = Hazed(GroundLight(sample, way), way * d.norm());
    } else {
      light = SkyColour(renderer_->scene_, renderer_->day_, renderer_->levels_, d.normalized());
    }
    return cards_.empty() ? light : BehindCards(sample, way, light);
  }

  Colour WallLight(const Sample& sample, Surface* wall, const UprightHit& hit) {
    if (wall->texture == nullptr) renderer_->PaintSurface(wall);
    const Paint paint = wall->texture->Look(hit.at, sample.On(*wall, hit.way));
    const LightLevels& levels = renderer_->levels_;
    const auto facing = static_cast<float>(wall->normal.dot(levels.to_sun_in_enu));
    Colour incident = 0.62F * levels.sky + 0.16F * (levels.sky + levels.sun);
    if (facing > 0.0F && levels.sun.g > 0.0F) {
      incident += (facing * renderer_->SunAt(wall->upright.At(hit.at))) * levels.sun;
    }
    Colour light = incident * paint.colour;
    if (paint.alpha > 0.02F) {
      const Eigen::Vector3d d = sample.ray.direction.normalized();
      const double along = d.dot(wall->normal);
      const auto grazing = static_cast<float>(1.0 + along);
      const float square = grazing * grazing;
      const float share = paint.alpha * (0.10F + 0.85F * square * square * grazing);
      light = Mix(light, Reflected(levels, d - 2.0 * along * wall->normal), share);
    }
    return light;
  }

  Colour GroundLight(const Sample& sample, double way) const {
    const Eigen::Vector3d& d = sample.ray.direction;
    const Eigen::Vector3d at = sample.ray.from + way * d;
    const Eigen::Vector3d x = way * (sample.by_x - sample.by_x.z() / d.z() * d);
    const Eigen::Vector3d y = way * (sample.by_y - sample.by_y.z() / d.z() * d);
    const Eigen::Vector2d footprint_m = x.head<2>().cwiseAbs() + y.head<2>().cwiseAbs();
    if (!(footprint_m.maxCoeff() < 1e3)) return HazeColour(renderer_->levels_);
    const LightLevels& levels = renderer_->levels_;
    float sun = 0.0F;
    if (levels.sun.g > 0.0F) {
      sun = static_cast<float>(levels.to_sun_in_enu.z()) * renderer_->SunAt(at);
    }
    const Colour colour =
        GroundColour(renderer_->scene_, renderer_->day_, at.head<2>(), footprint_m);
    return colour * (0.9F * levels.sky + sun * levels.sun);
  }

  Colour BehindCards(const Sample& sample, double way, const Colour& behind) {
    struct Layer {
      double way;
      Paint paint;
    };
    std::array<Layer, 8> layers;  // the farthest first
    std::size_t count = 0;
    for (Surface* card : cards_) {
      const std::optional<UprightHit> hit = Meet(sample.ray, card->upright, Sides::kBoth);
      if (!hit || hit->way >= way || count == layers.size()) continue;
      if (card->texture == nullptr) renderer_->PaintSurface(card);
      const Paint paint = card->texture->Look(hit->at, sample.On(*card, hit->way));
      if (paint.alpha <= 0.01F) continue;
      std::size_t place = count++;
      for (; place > 0 && layers[place - 1].way < hit->way; --place) {
        layers[place] = layers[place - 1];
      }
      layers[place] = {hit->way, paint};
    }
    const LightLevels& levels = renderer_->levels_;
    Colour light = behind;
    for (std::size_t i = 0; i < count; ++i) {
      // The texels' colours are mixed with the black of what is not there.
      const Colour own = (1.0F / layers[i].paint.alpha) * layers[i].paint.colour;
      const Colour lit = own * (0.8F * levels.sky + 0.55F * levels.sun);
      light = Mix(light, Hazed(lit, layers[i].way), layers[i].paint.alpha);
    }
    return light;
  }

  Colour Hazed(const Colour& light, double distance_m) const {
    const auto share = static_cast<float>(1.0 - std::exp(-distance_m / kHaze_m));
    return Mix(light, HazeColour(renderer_->levels_), share);
  }

  SceneRenderer* renderer_;
  Eigen::Matrix3d enu_from_camera_;
  Eigen::Vector3d centre_m_;
  std::vector<std::unique_ptr<Surface>> own_;  // of passers-by
  std::vector<Surface*> all_;
  std::vector<const Building*> roofs_;
  std::vector<Surface*> walls_;  // that the tile may meet
  std::vector<Surface*> cards_;
};

SceneRenderer::SceneRenderer(const Scene& scene, const Daylight& day, const ViewingPlan& plan)
    : scene_(scene), day_(day), levels_(LevelsOf(day)), plan_(plan) {
  for (std::size_t i = 0; i < scene.buildings.size(); ++i) {
    const Building& building = scene.buildings[i];
    int number = 0;
    for (const Upright& wall : WallsOf(building)) {
      surfaces_.push_back(Surface::Of(wall, Surface::Kind::kWall, building.seed));
      surfaces_.back()->facade = building.facade;
      surfaces_.back()->building = i;
      surfaces_.back()->wall = number++;
    }
  }
  for (const Tree& tree : scene.trees) {
    std::uint64_t number = 0;
    for (const Upright& card : TreeCards(tree)) {
      surfaces_.push_back(Surface::Of(card, Surface::Kind::kTree, tree.seed * 8 + number++));
    }
  }
}

SceneRenderer::~SceneRenderer() = default;

double SceneRenderer::TexelFor(const Upright& upright) const {
  double nearest_m = std::numeric_limits<double>::infinity();
  for (const Eigen::Vector3d& viewpoint : plan_.viewpoints_m) {
    const Eigen::Vector2d to = viewpoint.head<2>() - upright.foot;
    const double along_m = std::clamp(to.dot(upright.along), 0.0, upright.width_m);
    nearest_m = std::min(nearest_m, (to - along_m * upright.along).norm());
  }
  const double seen_m = 0.6 * nearest_m * plan_.pixel_angle_rad;
  const double affordable_m = std::sqrt(upright.width_m * upright.height_m / kMostTexels);
  return std::max(std::clamp(seen_m, kFinestTexel_m, kCoarsestTexel_m), affordable_m);
}

void SceneRenderer::PaintSurface(Surface* surface) {
  const double texel_m = TexelFor(surface->upright);
  if (surface->kind == Surface::Kind::kPerson) {
    surface->texture = std::make_unique<Texture>(PaintPerson(surface->seed, kFinestTexel_m));
    return;
  }
  if (surface->kind == Surface::Kind::kTree) {
    surface->texture = std::make_unique<Texture>(
        PaintTree(surface->upright.height_m, surface->seed, day_, std::max(texel_m, 0.02)));
    return;
  }
  FacadeDesign design;
  design.kind = surface->facade;
  design.width_m = surface->upright.width_m;
  design.height_m = surface->upright.height_m;
  design.building_seed = surface->seed;
  design.wall = surface->wall;
  const double facing = surface->normal.dot(levels_.to_sun_in_enu);
  if (facing > 0.15 && levels_.sun.g > 0.15F) {
    const Eigen::Vector3d along(surface->upright.along.x(), surface->upright.along.y(), 0.0);
    design.sun_slope_u = -levels_.to_sun_in_enu.dot(along) / facing;
    design.sun_slope_v = levels_.to_sun_in_enu.z() / facing;
  }
  PaintedFacade facade = PaintFacade(design, day_, texel_m);
  surface->texture = std::make_unique<Texture>(facade.canvas);
  surface->distinct_points = std::move(facade.distinct_points);
}

// 1 in the sun, 0 in the shadow of a building; trees' crowns let some light through.
float SceneRenderer::SunAt(const Eigen::Vector3d& point_m) const {
  const Ray ray = {point_m + 1e-3 * levels_.to_sun_in_enu, levels_.to_sun_in_enu};
  for (const std::unique_ptr<Surface>& surface : surfaces_) {
    if (surface->kind != Surface::Kind::kWall) break;  // the trees come after
    if (Meet(ray, surface->upright, Sides::kFront)) return 0.0F;
  }
  float sun = 1.0F;
  for (const Tree& tree : scene_.trees) {
    const Eigen::Vector3d crown(tree.at_m.x(), tree.at_m.y(), 0.64 * tree.height_m);
    const Eigen::Vector3d to = crown - ray.from;
    const double along = to.dot(ray.direction);
    if (along <= 0.0) continue;
    const double away = (to - along * ray.direction).norm() / (0.3 * tree.height_m);
    sun *= 0.3F + 0.7F * SmoothStep(0.75F, 1.05F, static_cast<float>(away));
  }
  return sun;
}

LightImage SceneRenderer::Render(const ViewRays& rays, const Rigid3& camera_from_enu,
                                 const std::vector<PasserBy>& passers_by) {
  LightImage image;
  image.width_px = rays.width_px();
  image.height_px = rays.height_px();
  image.pixels.resize(static_cast<std::size_t>(image.width_px) *
                      static_cast<std::size_t>(image.height_px));
  Frame frame(this, camera_from_enu, passers_by);
  for (int y_px = 0; y_px < image.height_px; y_px += kTile_px) {
    for (int x_px = 0; x_px < image.width_px; x_px += kTile_px) {
      frame.RenderTile(rays, x_px, y_px, &image);
    }
  }
  return image;
}

std::vector<DistinctPoint> SceneRenderer::DistinctPoints() {
  std::vector<DistinctPoint> points;
  for (const std::unique_ptr<Surface>& surface : surfaces_) {
    if (surface->kind != Surface::Kind::kWall) continue;
    if (surface->texture == nullptr) PaintSurface(surface.get());
    for (const CanvasPoint& point : surface->distinct_points) {
      points.push_back(
          {surface->building, surface->wall, surface->upright.At(point), surface->normal});
    }
  }
  return points;
}

bool SceneRenderer::Sees(const Eigen::Vector3d& from_m, const Eigen::Vector3d& point_m) const {
  // A ray of length 1 that ends a centimetre before the wall.
  const Eigen::Vector3d to = point_m - from_m;
  const Ray ray = {from_m, to};
  const double end = 1.0 - 0.01 / std::max(to.norm(), 0.02);
  for (const std::unique_ptr<Surface>& surface : surfaces_) {
    const std::optional<UprightHit> hit = Meet(ray, surface->upright, Sides::kBoth);
    if (hit && hit->way < end) return false;
  }
  return true;
}

}  // namespace lodemark
