//! Files: read, convert, write.
//!
//! ![110,000 points of a lidar tile, coloured by height][convert.png]
//!
//! ```sh
//! pellicle convert fixtures/pdal_autzen_trim.laz -o tile.ply
//! pellicle render tile.ply -o convert.png --up z --scalar z --views three-quarter --width 360 --height 280
//! ```
//!
//! The extension names the format: PLY, XYZ, PTS, PWN, CSV, PCD, LAS, LAZ, OFF, OBJ, STL, glTF and GLB are read. A file
//! appears under its name at once and complete, or not at all; one that exists is left as it is unless
//! [`Overwrite::Replace`](crate::io::Overwrite::Replace) says otherwise.
//!
//! ```
//! use pellicle::prelude::*;
//!
//! # let folder = tempfile::tempdir()?;
//! # let path = folder.path().join("two.ply");
//! let cloud = PointCloud::new(vec![DVec3::ZERO, DVec3::X])?;
//! write_points(&path, &cloud, &WriteOptions::default())?;
//! assert_eq!(read_points(&path, &ReadOptions::default())?.cloud, cloud);
//!
//! // Errors name the file and the place in it.
//! let text = std::io::Cursor::new("1 2 3\n4 5 north\n");
//! let error = io::read_from(text, io::Format::Xyz, "scan.xyz", &ReadOptions::default()).unwrap_err();
//! assert!(error.to_string().starts_with("scan.xyz: line 2: "));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! What was ignored or rounded on the way stands in the reports, as [`Note`](crate::io::Note)s.
//!
#![doc = include_str!("pictures/convert.md")]
