// SPDX-License-Identifier: BSD-3-Clause
// Functions of GDAL, which is loaded in a bounded child process when a file needs it.
#pragma once

#include <cstdint>
#include <string>

namespace ergocast {

/// The functions that are used, with the names and types of gdal.h, ogr_api.h and ogr_srs_api.h.
struct GdalLibrary {
  using Handle = void*;
  using Text = const char*;
  using Texts = const Text*;

  void (*CPLSetConfigOption)(Text name, Text value);
  void (*CPLSetErrorHandler)(void (*handler)(int level, int number, Text message));
  Handle (*GDALOpenEx)(Text file, unsigned flags, Texts drivers, Texts options, Texts siblings);

  int (*GDALDatasetGetLayerCount)(Handle dataset);
  Handle (*GDALDatasetGetLayer)(Handle dataset, int index);
  Text (*OGR_L_GetName)(Handle layer);
  int (*OGR_L_GetGeomType)(Handle layer);
  Handle (*OGR_L_GetSpatialRef)(Handle layer);
  Handle (*OGR_L_GetNextFeature)(Handle layer);
  void (*OGR_F_Destroy)(Handle feature);
  std::int64_t (*OGR_F_GetFID)(Handle feature);
  Handle (*OGR_F_GetGeometryRef)(Handle feature);
  int (*OGR_G_GetGeometryType)(Handle geometry);
  Text (*OGR_G_GetGeometryName)(Handle geometry);
  int (*OGR_GT_Flatten)(int type);
  int (*OGR_G_GetGeometryCount)(Handle geometry);
  Handle (*OGR_G_GetGeometryRef)(Handle geometry, int index);
  int (*OGR_G_GetPointCount)(Handle ring);
  double (*OGR_G_GetX)(Handle ring, int index);
  double (*OGR_G_GetY)(Handle ring, int index);

  int (*GDALGetRasterXSize)(Handle dataset);
  int (*GDALGetRasterYSize)(Handle dataset);
  int (*GDALGetRasterCount)(Handle dataset);
  int (*GDALGetGeoTransform)(Handle dataset, double* six);
  Handle (*GDALGetSpatialRef)(Handle dataset);
  Handle (*GDALGetRasterBand)(Handle dataset, int index);
  Handle (*GDALGetRasterColorTable)(Handle band);
  int (*GDALGetRasterDataType)(Handle band);
  int (*GDALDataTypeIsComplex)(int type);
  double (*GDALGetRasterScale)(Handle band, int* is_set);
  double (*GDALGetRasterOffset)(Handle band, int* is_set);
  int (*GDALGetRasterColorInterpretation)(Handle band);
  Handle (*GDALGetMaskBand)(Handle band);
  int (*GDALRasterIO)(Handle band, int write, int x, int y, int width, int height, void* buffer,
                      int buffer_width, int buffer_height, int type, int pixel_bytes,
                      int line_bytes);

  Handle (*OSRNewSpatialReference)(Text text);
  Handle (*OSRClone)(Handle reference);
  int (*OSRIsLocal)(Handle reference);
  int (*OSRImportFromProj4)(Handle reference, Text text);
  void (*OSRSetAxisMappingStrategy)(Handle reference, int strategy);
  Handle (*OCTNewCoordinateTransformationOptions)();
  int (*OCTCoordinateTransformationOptionsSetBallparkAllowed)(Handle options, int allowed);
  Handle (*OCTNewCoordinateTransformationEx)(Handle from, Handle to, Handle options);
  int (*OCTTransformEx)(Handle transformation, int count, double* x, double* y, double* z,
                        int* success);

  /// Loads the library with these drivers and no others: none that follows a file to another place.
  /// @param drivers    names of functions that register one, which end with a nullptr
  /// @param warnings   whether warnings count as errors
  bool load(const char* const* drivers, bool warnings);
  /// What the library reported first, after ": "; empty if nothing.
  static std::string reported();

  /// Longitude before latitude, east before north. Nothing (nullptr) if GDAL knows no way that is
  /// as exact as the two systems.
  Handle transformation(Handle from, Handle to) const;
  /// The plane or the earth that PROJ's text describes.
  Handle reference(const std::string& proj) const;
};

/// What is missing where load() fails, and what installs it on this system.
std::string gdal_is_missing();
std::string gdal_remedy();

}  // namespace ergocast
