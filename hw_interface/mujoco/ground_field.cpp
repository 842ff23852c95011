#include "hw_interface/mujoco/ground_field.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "models/excavator/mujoco_model.hpp"

namespace wex {
namespace {

constexpr const char* kGroundMaterial = "ground";
constexpr double kPitDepth_m = 2.0;
constexpr double kBaseThickness_m = 1.0;
constexpr double kSceneRadius_m = 10.0;
constexpr double kFlattest_m = 0.01;  ///< a height field needs some range

double extent_m(int size, double cell_m) { return (size - 1) * cell_m; }

}  // namespace

void add_ground(mjSpec* spec, const Grid& elevation, double friction) {
  float lowest = std::numeric_limits<float>::infinity();
  float highest = -lowest;
  bool any_unknown = false;
  for (const float z : elevation.values) {
    if (std::isnan(z)) {
      any_unknown = true;
    } else {
      lowest = std::min(lowest, z);
      highest = std::max(highest, z);
    }
  }
  const float pit = any_unknown ? lowest - static_cast<float>(kPitDepth_m) : lowest;
  // MuJoCo scales the samples to their own range, so the range is what the field's height is.
  std::vector<float> samples(elevation.values.size());
  std::transform(elevation.values.begin(), elevation.values.end(), samples.begin(),
                 [pit](float z) { return std::isnan(z) ? 0.0F : z - pit; });
  const double width_m = extent_m(elevation.size_x, elevation.cell_m);
  const double depth_m = extent_m(elevation.size_y, elevation.cell_m);

  mjsHField* field = mjs_addHField(spec);
  mjs_setName(field->element, kGroundName);
  field->ncol = elevation.size_x;
  field->nrow = elevation.size_y;
  field->size[0] = width_m / 2.0;
  field->size[1] = depth_m / 2.0;
  field->size[2] = std::max(static_cast<double>(highest - pit), kFlattest_m);
  field->size[3] = kBaseThickness_m;
  mjs_setFloat(field->userdata, samples.data(), static_cast<int>(samples.size()));

  mjsGeom* geom = mjs_addGeom(mjs_findBody(spec, "world"), nullptr);
  mjs_setName(geom->element, kGroundName);
  geom->type = mjGEOM_HFIELD;
  mjs_setString(geom->hfieldname, kGroundName);
  mjs_setString(geom->material, kGroundMaterial);
  geom->pos[0] = elevation.origin_m.x() + width_m / 2.0;
  geom->pos[1] = elevation.origin_m.y() + depth_m / 2.0;
  geom->pos[2] = static_cast<double>(pit);
  geom->friction[0] = friction;
  geom->contype = kGroundContactType;
  geom->conaffinity = kMachineContactType;
}

void add_scenery(mjSpec* spec, const Grid& elevation, const std::string& followed_body) {
  mjsTexture* checker = mjs_addTexture(spec, nullptr);
  mjs_setName(checker->element, kGroundMaterial);
  checker->type = mjTEXTURE_2D;
  checker->builtin = mjBUILTIN_CHECKER;
  checker->width = checker->height = 256;
  const double light[3] = {0.52, 0.47, 0.38}, dark[3] = {0.45, 0.41, 0.33};
  std::copy(light, light + 3, checker->rgb1);
  std::copy(dark, dark + 3, checker->rgb2);

  // One tile of the texture is two squares: squares of one metre.
  mjsMaterial* material = mjs_addMaterial(spec, nullptr);
  mjs_setName(material->element, kGroundMaterial);
  mjs_setInStringVec(material->textures, mjTEXROLE_RGB, kGroundMaterial);
  material->texrepeat[0] = static_cast<float>(extent_m(elevation.size_x, elevation.cell_m) / 2.0);
  material->texrepeat[1] = static_cast<float>(extent_m(elevation.size_y, elevation.cell_m) / 2.0);
  material->specular = 0.0F;

  mjsTexture* sky = mjs_addTexture(spec, nullptr);
  mjs_setName(sky->element, "sky");
  sky->type = mjTEXTURE_SKYBOX;
  sky->builtin = mjBUILTIN_GRADIENT;
  sky->width = 256;
  sky->height = 256 * 6;
  const double horizon[3] = {0.80, 0.88, 0.95}, zenith[3] = {0.42, 0.60, 0.82};
  std::copy(horizon, horizon + 3, sky->rgb1);
  std::copy(zenith, zenith + 3, sky->rgb2);

  mjsLight* sun = mjs_addLight(mjs_findBody(spec, followed_body.c_str()), nullptr);
  sun->type = mjLIGHT_DIRECTIONAL;
  sun->mode = mjCAMLIGHT_TRACK;
  const double position[3] = {-6.0, 5.0, 14.0}, direction[3] = {6.0, -5.0, -14.0};
  std::copy(position, position + 3, sun->pos);
  std::copy(direction, direction + 3, sun->dir);
  sun->castshadow = 1;
  for (float& channel : sun->diffuse) channel = 0.65F;
  for (float& channel : sun->specular) channel = 0.05F;
  spec->stat.extent = kSceneRadius_m;  // shadows and clipping planes are scaled by it
  spec->visual.quality.shadowsize = 4096;
  spec->visual.map.shadowclip = 1.5F;
  for (float& channel : spec->visual.headlight.ambient) channel = 0.35F;
  for (float& channel : spec->visual.headlight.diffuse) channel = 0.25F;
  for (float& channel : spec->visual.headlight.specular) channel = 0.0F;
}

}  // namespace wex
