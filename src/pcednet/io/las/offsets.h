#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

/// Offsets of the fields of a LAS file, in bytes from the beginning of their block.
namespace pcednet::io {

/// The public header block (ASPRS LAS 1.4 R15, table 3; the time range is of LAS 1.5).
namespace las_header {
inline constexpr std::size_t kSignature = 0, kGlobalEncoding = 6, kMajorVersion = 24,
                             kMinorVersion = 25, kSystem = 26, kSoftware = 58, kCreationDay = 90,
                             kCreationYear = 92, kHeaderBytes = 94, kPointsOffset = 96,
                             kRecordCount = 100, kPointFormat = 104, kRecordLength = 105,
                             kPointCount32 = 107, kByReturn32 = 111, kScales = 131, kOffsets = 155,
                             kBounds = 179;     ///< largest and least x, then y, then z
inline constexpr std::size_t kWaveforms = 227;  ///< since 1.3
inline constexpr std::size_t kExtendedRecords = 235, kExtendedCount = 243, kPointCount64 = 247,
                             kByReturn64 = 255;  ///< since 1.4
inline constexpr std::size_t kLastTime = 375, kFirstTime = 383,
                             kTimeOffset = 391;  ///< since 1.5

inline constexpr std::size_t kTextBytes = 32;  ///< of the system and of the software
inline constexpr std::size_t kReturns32 = 5, kReturns64 = 15;

/// Bytes of the whole block.
inline constexpr std::size_t kLeastBytes = 227, kBytes13 = 235, kBytes14 = 375, kBytes15 = 393;

/// Bits of the point format's byte: LASzip sets the upper two.
inline constexpr unsigned kFormatBits = 0x3F, kCompressedBits = 0xC0, kCompressedBit = 0x80;
inline constexpr unsigned kStandardTimeBit = 1, kWktBit = 16,
                          kTimeOffsetBit = 64;  ///< of the global encoding
}  // namespace las_header

/// A variable length record, before its data; the description is its last field.
namespace las_record {
inline constexpr std::size_t kUserId = 2, kRecordId = 18, kLength = 20;
inline constexpr std::size_t kUserIdBytes = 16, kDescriptionBytes = 32;
inline constexpr std::size_t kHeadBytes = 54,
                             kExtendedHeadBytes = 60;  ///< 16 and 64 bits of length
}  // namespace las_record

/// One entry of the record that describes extra bytes.
namespace las_descriptor {
inline constexpr std::size_t kType = 2, kOptions = 3, kName = 4, kNoData = 40, kLeast = 64,
                             kScale = 112, kOffset = 136, kDescription = 160;
inline constexpr std::size_t kNameBytes = 32, kDescriptionBytes = 32, kBytes = 192;
inline constexpr unsigned kNoDataBit = 1, kLeastBit = 2, kMostBit = 4, kScaleBit = 8,
                          kOffsetBit = 16;  ///< of the options
}  // namespace las_descriptor

/// The record of LASzip, and one of the items that follow it.
namespace laz_record {
inline constexpr std::size_t kCompressor = 0, kCoder = 2, kMajorVersion = 4, kMinorVersion = 5,
                             kChunkSize = 12, kSpecialCount = 16, kSpecialOffset = 24,
                             kItemCount = 32, kItems = 34;
inline constexpr std::size_t kItemType = 0, kItemSize = 2, kItemVersion = 4, kItemBytes = 6;
inline constexpr std::uint32_t kVariableSize = UINT32_MAX;  ///< the chunk table says each size
}  // namespace laz_record

/// The chunk table behind the compressed points.
namespace laz_table {
inline constexpr std::size_t kVersion = 0, kChunkCount = 4, kChunks = 8;
}

/// The record of COPC 1.0 that must be the first, and an entry of the hierarchy.
namespace copc_info {
inline constexpr std::size_t kCentre = 0, kHalfSide = 24, kSpacing = 32, kHierarchy = 40,
                             kHierarchyBytes = 48, kFirstTime = 56, kLastTime = 64, kBytes = 160;
}
namespace copc_entry {
inline constexpr std::size_t kDepth = 0, kCell = 4, kPlace = 16, kChunkBytes = 24, kPoints = 28,
                             kBytes = 32;
}

/// The known records: user id and record id.
struct LasRecordKind {
  std::string_view user_id;
  std::uint16_t record_id;
};
inline constexpr LasRecordKind kWktRecord{"LASF_Projection", 2112},
    kGeoKeysRecord{"LASF_Projection", 34735}, kGeoTextRecord{"LASF_Projection", 34737},
    kExtraBytesRecord{"LASF_Spec", 4}, kWaveformsRecord{"LASF_Spec", 65535},
    kLaszipRecord{"laszip encoded", 22204}, kCopcInfoRecord{"copc", 1},
    kCopcHierarchyRecord{"copc", 1000}, kCommentsRecord{"pcednet", 1};

inline constexpr double kLasAngleStep = 0.006;  ///< degrees of ScanAngle, in formats 6 to 10

/// The names of the fields of colours, and of the extra bytes that hold normals.
inline constexpr const char* kLasChannels[] = {"Red", "Green", "Blue"};
inline constexpr const char* kLasNormals[] = {"NormalX", "NormalY", "NormalZ"};

}  // namespace pcednet::io
