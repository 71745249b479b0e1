// SPDX-License-Identifier: BSD-3-Clause
// Looks for the library under the names of its releases.
#include "target/geo/gdal_library.h"

#include <dlfcn.h>

#include <cstdlib>
#include <fstream>

#include "target/maps/symbol.h"

namespace ergocast {
namespace {

/// The functions above are the same in all these releases.
constexpr const char* kNames[] = {"libgdal.so.32", "libgdal.so.36", "libgdal.so.34",
                                  "libgdal.so.30", "libgdal.so.35", "libgdal.so.37"};
constexpr int kWarning = 2, kFailure = 3;

int least_level = kFailure;
std::string first_error;  // NOLINT(*-global-variables): GDAL's handler takes no other place

void note_error(int level, int /*number*/, const char* message) {
  if (level >= least_level && first_error.empty()) first_error = message;
}

}  // namespace

std::string GdalLibrary::reported() {
  constexpr std::size_t kMost = 200;
  if (first_error.size() > kMost) {
    first_error.resize(kMost);
    first_error += " …";
  }
  return first_error.empty() ? "" : ": " + first_error;
}

bool GdalLibrary::load(const char* const* drivers, bool warnings) {
  setenv("OPENBLAS_NUM_THREADS", "1", 1);  // each thread of it would take memory
  void* handle = nullptr;
  for (const char* name : kNames)
    if (handle == nullptr) handle = dlopen(name, RTLD_LAZY | RTLD_LOCAL);
  if (handle == nullptr) return false;
  bool complete = true;
#define ERGOCAST_FIND(name) complete = find_symbol(handle, #name, name) && complete
  ERGOCAST_FIND(CPLSetConfigOption);
  ERGOCAST_FIND(CPLSetErrorHandler);
  ERGOCAST_FIND(GDALOpenEx);
  ERGOCAST_FIND(GDALDatasetGetLayerCount);
  ERGOCAST_FIND(GDALDatasetGetLayer);
  ERGOCAST_FIND(OGR_L_GetName);
  ERGOCAST_FIND(OGR_L_GetGeomType);
  ERGOCAST_FIND(OGR_L_GetSpatialRef);
  ERGOCAST_FIND(OGR_L_GetNextFeature);
  ERGOCAST_FIND(OGR_F_Destroy);
  ERGOCAST_FIND(OGR_F_GetFID);
  ERGOCAST_FIND(OGR_F_GetGeometryRef);
  ERGOCAST_FIND(OGR_G_GetGeometryType);
  ERGOCAST_FIND(OGR_G_GetGeometryName);
  ERGOCAST_FIND(OGR_GT_Flatten);
  ERGOCAST_FIND(OGR_G_GetGeometryCount);
  ERGOCAST_FIND(OGR_G_GetGeometryRef);
  ERGOCAST_FIND(OGR_G_GetPointCount);
  ERGOCAST_FIND(OGR_G_GetX);
  ERGOCAST_FIND(OGR_G_GetY);
  ERGOCAST_FIND(GDALGetRasterXSize);
  ERGOCAST_FIND(GDALGetRasterYSize);
  ERGOCAST_FIND(GDALGetRasterCount);
  ERGOCAST_FIND(GDALGetGeoTransform);
  ERGOCAST_FIND(GDALGetSpatialRef);
  ERGOCAST_FIND(GDALGetRasterBand);
  ERGOCAST_FIND(GDALGetRasterColorTable);
  ERGOCAST_FIND(GDALGetRasterDataType);
  ERGOCAST_FIND(GDALDataTypeIsComplex);
  ERGOCAST_FIND(GDALGetRasterScale);
  ERGOCAST_FIND(GDALGetRasterOffset);
  ERGOCAST_FIND(GDALGetRasterColorInterpretation);
  ERGOCAST_FIND(GDALGetMaskBand);
  ERGOCAST_FIND(GDALRasterIO);
  ERGOCAST_FIND(OSRNewSpatialReference);
  ERGOCAST_FIND(OSRClone);
  ERGOCAST_FIND(OSRIsLocal);
  ERGOCAST_FIND(OSRImportFromProj4);
  ERGOCAST_FIND(OSRSetAxisMappingStrategy);
  ERGOCAST_FIND(OCTNewCoordinateTransformationOptions);
  ERGOCAST_FIND(OCTCoordinateTransformationOptionsSetBallparkAllowed);
  ERGOCAST_FIND(OCTNewCoordinateTransformationEx);
  ERGOCAST_FIND(OCTTransformEx);
#undef ERGOCAST_FIND
  if (!complete) return false;
  least_level = warnings ? kWarning : kFailure;
  CPLSetErrorHandler(note_error);
  CPLSetConfigOption("PROJ_NETWORK", "OFF");
  CPLSetConfigOption("GDAL_NUM_THREADS", "1");
  CPLSetConfigOption("GDAL_CACHEMAX", "64");  // MiB
  CPLSetConfigOption("OGR_ENABLE_PARTIAL_REPROJECTION", "NO");
  void (*enter)() = nullptr;
  for (; *drivers != nullptr; ++drivers) {
    if (!find_symbol(handle, *drivers, enter)) return false;
    enter();
  }
  return true;
}

GdalLibrary::Handle GdalLibrary::transformation(Handle from, Handle to) const {
  constexpr int kEastBeforeNorth = 0;
  const Handle options = OCTNewCoordinateTransformationOptions();
  OCTCoordinateTransformationOptionsSetBallparkAllowed(options, 0);
  const Handle source = OSRClone(from), target = OSRClone(to);
  OSRSetAxisMappingStrategy(source, kEastBeforeNorth);
  OSRSetAxisMappingStrategy(target, kEastBeforeNorth);
  return OCTNewCoordinateTransformationEx(source, target, options);
}

GdalLibrary::Handle GdalLibrary::reference(const std::string& proj) const {
  const Handle reference = OSRNewSpatialReference(nullptr);
  OSRImportFromProj4(reference, proj.c_str());
  return reference;
}

std::string gdal_is_missing() { return "needs GDAL, which this machine does not have"; }

std::string gdal_remedy() {
  std::ifstream system("/etc/os-release");
  for (std::string line; std::getline(system, line);) {
    if (line == "VERSION_CODENAME=bookworm") return "apt install libgdal32";
    if (line == "VERSION_CODENAME=trixie") return "apt install libgdal36";
  }
  return "apt install gdal-bin";
}

}  // namespace ergocast
