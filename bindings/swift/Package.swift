// swift-tools-version:5.5
import PackageDescription

// Sources/CMien is made by prepare.sh: the library as mien.h and a source for each tier.
let package = Package(
  name: "Mien",
  platforms: [.iOS(.v13), .macOS(.v11)],
  products: [.library(name: "Mien", targets: ["Mien"])],
  targets: [
    .target(name: "CMien", publicHeadersPath: "."),
    .target(name: "Mien", dependencies: ["CMien"]),
    .testTarget(name: "MienTests", dependencies: ["Mien"]),
  ],
  cxxLanguageStandard: .cxx20
)
