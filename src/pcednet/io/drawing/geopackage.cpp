#include "pcednet/core/error.h"
#include "pcednet/io/drawing/writers.h"

#ifdef PCEDNET_WITH_SQLITE
#include <fmt/format.h>
#include <sqlite3.h>

#include <memory>

#include "pcednet/io/drawing/line_classes.h"
#include "pcednet/io/projection.h"

namespace pcednet::io {
namespace {

/// The tables that GeoPackage 1.3 requires, and the layer. A fixed time, for the same bytes each
/// time.
constexpr const char* kTables = R"(
PRAGMA application_id = 0x47504B47;
PRAGMA user_version = 10300;
BEGIN;
CREATE TABLE gpkg_spatial_ref_sys (srs_name TEXT NOT NULL, srs_id INTEGER NOT NULL PRIMARY KEY,
  organization TEXT NOT NULL, organization_coordsys_id INTEGER NOT NULL,
  definition TEXT NOT NULL, description TEXT);
INSERT INTO gpkg_spatial_ref_sys VALUES
  ('Undefined cartesian SRS', -1, 'NONE', -1, 'undefined', 'undefined cartesian coordinates'),
  ('Undefined geographic SRS', 0, 'NONE', 0, 'undefined', 'undefined geographic coordinates'),
  ('WGS 84 geodetic', 4326, 'EPSG', 4326, 'GEOGCS["WGS 84",DATUM["WGS_1984",SPHEROID["WGS 84",6378137,298.257223563,AUTHORITY["EPSG","7030"]],AUTHORITY["EPSG","6326"]],PRIMEM["Greenwich",0,AUTHORITY["EPSG","8901"]],UNIT["degree",0.0174532925199433,AUTHORITY["EPSG","9122"]],AXIS["Latitude",NORTH],AXIS["Longitude",EAST],AUTHORITY["EPSG","4326"]]', 'longitude and latitude on WGS 84');
CREATE TABLE gpkg_contents (table_name TEXT NOT NULL PRIMARY KEY, data_type TEXT NOT NULL,
  identifier TEXT UNIQUE, description TEXT DEFAULT '',
  last_change DATETIME NOT NULL DEFAULT (strftime('%Y-%m-%dT%H:%M:%fZ','now')),
  min_x DOUBLE, min_y DOUBLE, max_x DOUBLE, max_y DOUBLE, srs_id INTEGER,
  CONSTRAINT fk_gc_r_srs_id FOREIGN KEY (srs_id) REFERENCES gpkg_spatial_ref_sys(srs_id));
CREATE TABLE gpkg_geometry_columns (table_name TEXT NOT NULL, column_name TEXT NOT NULL,
  geometry_type_name TEXT NOT NULL, srs_id INTEGER NOT NULL, z TINYINT NOT NULL, m TINYINT NOT NULL,
  CONSTRAINT pk_geom_cols PRIMARY KEY (table_name, column_name),
  CONSTRAINT uk_gc_table_name UNIQUE (table_name),
  CONSTRAINT fk_gc_tn FOREIGN KEY (table_name) REFERENCES gpkg_contents(table_name),
  CONSTRAINT fk_gc_srs FOREIGN KEY (srs_id) REFERENCES gpkg_spatial_ref_sys(srs_id));
CREATE TABLE edges (fid INTEGER PRIMARY KEY AUTOINCREMENT NOT NULL, geom LINESTRING,
  class TEXT, kind TEXT, length DOUBLE, confidence DOUBLE, dihedral_angle DOUBLE, points INTEGER,
  radius DOUBLE);
)";

constexpr int kUndefined = -1;

/// An ISO 19162 definition has a separate column, by the extension for it.
constexpr const char* kWkt2Tables = R"(
ALTER TABLE gpkg_spatial_ref_sys ADD COLUMN definition_12_063 TEXT NOT NULL DEFAULT 'undefined';
CREATE TABLE gpkg_extensions (table_name TEXT, column_name TEXT, extension_name TEXT NOT NULL,
  definition TEXT NOT NULL, scope TEXT NOT NULL,
  CONSTRAINT ge_tce UNIQUE (table_name, column_name, extension_name));
INSERT INTO gpkg_extensions VALUES ('gpkg_spatial_ref_sys', 'definition_12_063', 'gpkg_crs_wkt',
  'http://www.geopackage.org/spec120/#extension_crs_wkt', 'read-write');
)";

/// A database in memory; every failure throws an Error that names the file it is for.
class Database {
 public:
  explicit Database(const std::filesystem::path& path) : path_(path) {
    check(sqlite3_open(":memory:", &handle_));
  }
  ~Database() { sqlite3_close(handle_); }
  Database(const Database&) = delete;
  Database& operator=(const Database&) = delete;

  void execute(const char* statements) {
    check(sqlite3_exec(handle_, statements, nullptr, nullptr, nullptr));
  }

  void check(int code) const {
    if (code == SQLITE_OK || code == SQLITE_DONE) return;
    throw Error(ErrorKind::kFailure,
                fmt::format("{}: SQLite: {}", path_.string(), sqlite3_errmsg(handle_)));
  }

  sqlite3* handle() const { return handle_; }

  /// The bytes of its file.
  void write(Overwrite overwrite) const {
    sqlite3_int64 size = 0;
    const std::unique_ptr<unsigned char, void (*)(void*)> bytes(
        sqlite3_serialize(handle_, "main", &size, 0), sqlite3_free);
    if (!bytes) throw Error(ErrorKind::kFailure, path_.string() + ": SQLite: out of memory");
    write_text_file(path_,
                    {reinterpret_cast<const char*>(bytes.get()), static_cast<std::size_t>(size)},
                    overwrite);
  }

 private:
  const std::filesystem::path& path_;
  sqlite3* handle_ = nullptr;
};

/// A statement whose parameters are bound one after the other.
class Insertion {
 public:
  Insertion(const Database& database, const char* statement) : database_(database) {
    database.check(sqlite3_prepare_v2(database.handle(), statement, -1, &handle_, nullptr));
  }
  ~Insertion() { sqlite3_finalize(handle_); }
  Insertion(const Insertion&) = delete;
  Insertion& operator=(const Insertion&) = delete;

  Insertion& text(std::string_view value) {
    return bound(sqlite3_bind_text(handle_, ++place_, value.data(), static_cast<int>(value.size()),
                                   SQLITE_TRANSIENT));
  }
  Insertion& blob(std::string_view value) {
    return bound(
        sqlite3_bind_blob64(handle_, ++place_, value.data(), value.size(), SQLITE_TRANSIENT));
  }
  Insertion& number(double value) { return bound(sqlite3_bind_double(handle_, ++place_, value)); }
  Insertion& integer(std::int64_t value) {
    return bound(sqlite3_bind_int64(handle_, ++place_, value));
  }
  Insertion& nothing() { return bound(sqlite3_bind_null(handle_, ++place_)); }

  void run() {
    database_.check(sqlite3_step(handle_));
    database_.check(sqlite3_reset(handle_));
    place_ = 0;
  }

 private:
  Insertion& bound(int code) {
    database_.check(code);
    return *this;
  }

  const Database& database_;
  sqlite3_stmt* handle_ = nullptr;
  int place_ = 0;
};

/// GeoPackageBinary: a header with the box, then a LineString Z as well-known binary.
std::string geometry_of(const std::vector<Vec3>& points, int srs) {
  constexpr std::uint8_t kVersion1 = 0, kLittleEndianBoxOfXyz = 0x05;
  constexpr std::uint32_t kLineStringZ = 1002;
  const BoundingBox box = bounding_box(points);
  std::string bytes = "GP";
  append_little(bytes, kVersion1);
  append_little(bytes, kLittleEndianBoxOfXyz);
  append_little(bytes, static_cast<std::int32_t>(srs));
  for (int axis = 0; axis < 3; ++axis) {
    append_little(bytes, box.min[axis]);
    append_little(bytes, box.max[axis]);
  }
  append_little(bytes, std::uint8_t{1});
  append_little(bytes, kLineStringZ);
  append_little(bytes, static_cast<std::uint32_t>(points.size()));
  for (const Vec3& point : points) {
    for (const double coordinate : point) append_little(bytes, coordinate);
  }
  return bytes;
}

bool is_wkt2(std::string_view wkt) {
  const std::string_view keyword = wkt.substr(0, wkt.find('['));
  return keyword.ends_with("CRS");
}

/// Adds the coordinate system and returns its number in the file.
int add_system(Database& database, CoordinateSystem system) {
  constexpr int kWgs84 = 4326, kOwn = 100000;
  if (is_of_heights_alone(system)) return kUndefined;
  if (system.epsg == 0 && system.wkt.empty()) return kUndefined;
  if (system.epsg == kWgs84) return kWgs84;
  const int srs = system.epsg > 0 ? system.epsg : kOwn;
  if (system.wkt.empty()) system.wkt = definition_of({.epsg = system.epsg}, WktVersion::k1);
  const bool modern = is_wkt2(system.wkt);
  if (modern) database.execute(kWkt2Tables);
  Insertion row(database, modern
                              ? "INSERT INTO gpkg_spatial_ref_sys VALUES (?, ?, ?, ?, ?, NULL, ?)"
                              : "INSERT INTO gpkg_spatial_ref_sys VALUES (?, ?, ?, ?, ?, NULL)");
  const std::string name =
      system.epsg > 0 ? fmt::format("EPSG:{}", system.epsg) : std::string("that of the cloud");
  row.text(name).integer(srs).text(system.epsg > 0 ? "EPSG" : "NONE").integer(srs);
  const bool has_first = !modern && !system.wkt.empty();
  row.text(has_first ? std::string_view(system.wkt) : "undefined");
  if (modern) row.text(system.wkt);
  row.run();
  return srs;
}

void add_contents(Database& database, const BoundingBox& box, int srs) {
  Insertion contents(database,
                     "INSERT INTO gpkg_contents VALUES ('edges', 'features', 'edges', '', "
                     "'2000-01-01T00:00:00.000Z', ?, ?, ?, ?, ?)");
  for (const Vec3* corner : {&box.min, &box.max}) {
    for (int axis = 0; axis < 2; ++axis) {
      box.empty() ? contents.nothing() : contents.number((*corner)[axis]);
    }
  }
  contents.integer(srs).run();
  Insertion column(database,
                   "INSERT INTO gpkg_geometry_columns VALUES ('edges', 'geom', 'LINESTRING', ?, "
                   "1, 0)");
  column.integer(srs).run();
}

}  // namespace

bool has_geopackage() {
  return true;
}

void write_geopackage(const std::filesystem::path& path, Curves curves,
                      const DrawingOptions& options) {
  Database database(path);
  database.execute(kTables);
  const int srs = add_system(database, options.coordinate_system);
  add_contents(database, drawn_box(curves, options), srs);
  {
    Insertion row(database, "INSERT INTO edges VALUES (NULL, ?, ?, ?, ?, ?, ?, ?, ?)");
    for (const lines::Curve& curve : curves) {
      row.blob(geometry_of(drawn(curve, options), srs));
      row.text(line_class(curve.edge_class).name).text(name_of(curve.kind));
      row.number(length_of(curve)).number(curve.confidence).number(dihedral_degrees(curve));
      row.integer(static_cast<std::int64_t>(curve.support));
      curve.radius > 0.0 ? row.number(curve.radius) : row.nothing();
      row.run();
    }
  }
  database.execute("COMMIT");
  database.write(options.overwrite);
}

}  // namespace pcednet::io

#else

namespace pcednet::io {

bool has_geopackage() {
  return false;
}

void write_geopackage(const std::filesystem::path& path, Curves, const DrawingOptions&) {
  drawing_format_for(path);  // throws
}

}  // namespace pcednet::io

#endif
