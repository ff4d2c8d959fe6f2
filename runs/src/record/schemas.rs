//! How a recording describes its messages: descriptors that any reader of protocol buffers understands.

use prost::Message;
use prost_types::field_descriptor_proto::{Label, Type};
use prost_types::{
    DescriptorProto, EnumDescriptorProto, EnumValueDescriptorProto, FieldDescriptorProto, FileDescriptorProto,
    FileDescriptorSet, OneofDescriptorProto,
};

/// A message and its fields, by their numbers from 1 on.
pub(crate) struct Schema {
    package: &'static str,
    name: &'static str,
    fields: &'static [(&'static str, Kind)],
}

/// What a field holds.
#[derive(Clone, Copy)]
enum Kind {
    Double,
    /// A double that may be absent.
    Maybe,
    Doubles,
    Flag,
    Flags,
    Text,
    Bytes,
    Int32,
    Int64,
    Uint32,
    Uint64,
    Fixed32,
    Level,
    One(&'static Schema),
    Many(&'static Schema),
    /// A field with this number exists, but is never written.
    Unused,
}

const FOXGLOVE: &str = "foxglove";
const OURS: &str = "arl2rs.v1";

static TIMESTAMP: Schema = Schema {
    package: "google.protobuf",
    name: "Timestamp",
    fields: &[("seconds", Kind::Int64), ("nanos", Kind::Int32)],
};
static VECTOR: Schema = Schema {
    package: FOXGLOVE,
    name: "Vector3",
    fields: &[("x", Kind::Double), ("y", Kind::Double), ("z", Kind::Double)],
};
static QUATERNION: Schema = Schema {
    package: FOXGLOVE,
    name: "Quaternion",
    fields: &[("x", Kind::Double), ("y", Kind::Double), ("z", Kind::Double), ("w", Kind::Double)],
};
static FRAME_TRANSFORM: Schema = Schema {
    package: FOXGLOVE,
    name: "FrameTransform",
    fields: &[
        ("timestamp", Kind::One(&TIMESTAMP)),
        ("parent_frame_id", Kind::Text),
        ("child_frame_id", Kind::Text),
        ("translation", Kind::One(&VECTOR)),
        ("rotation", Kind::One(&QUATERNION)),
    ],
};
static JOINT_STATE: Schema =
    Schema { package: FOXGLOVE, name: "JointState", fields: &[("name", Kind::Text), ("position", Kind::Maybe)] };
static RUNS: Schema = Schema {
    package: OURS,
    name: "Runs",
    fields: &[
        ("program", Kind::Text),
        ("robot", Kind::Text),
        ("axes", Kind::Many(&AXIS)),
        ("links", Kind::Many(&LINK)),
        ("tcp", Kind::Text),
        ("carriers", Kind::Many(&LINK)),
    ],
};
static LINK: Schema = Schema {
    package: OURS,
    name: "Link",
    fields: &[
        ("frame", Kind::Text),
        ("parent", Kind::Text),
        ("origin", Kind::Doubles),
        ("axis", Kind::Doubles),
        ("linear", Kind::Flag),
        ("moved_by", Kind::Text),
    ],
};
static AXIS: Schema = Schema {
    package: OURS,
    name: "Axis",
    fields: &[("name", Kind::Text), ("unit", Kind::Text), ("min", Kind::Double), ("max", Kind::Double)],
};
static NAME: Schema = Schema { package: OURS, name: "Name", fields: &[("signal", Kind::Text), ("name", Kind::Text)] };
static BLEND: Schema = Schema {
    package: OURS,
    name: "Blend",
    fields: &[("asked", Kind::Double), ("used", Kind::Double), ("unit", Kind::Text), ("why", Kind::Text)],
};
static CLOSEST: Schema =
    Schema { package: OURS, name: "Closest", fields: &[("of", Kind::Text), ("percent", Kind::Double)] };

static POSE: Schema = Schema {
    package: FOXGLOVE,
    name: "Pose",
    fields: &[("position", Kind::One(&VECTOR)), ("orientation", Kind::One(&QUATERNION))],
};
static COLOR: Schema = Schema {
    package: FOXGLOVE,
    name: "Color",
    fields: &[("r", Kind::Double), ("g", Kind::Double), ("b", Kind::Double), ("a", Kind::Double)],
};
const SOLID: &[(&str, Kind)] =
    &[("pose", Kind::One(&POSE)), ("size", Kind::One(&VECTOR)), ("color", Kind::One(&COLOR))];
static CUBE: Schema = Schema { package: FOXGLOVE, name: "CubePrimitive", fields: SOLID };
static SPHERE: Schema = Schema { package: FOXGLOVE, name: "SpherePrimitive", fields: SOLID };
static CYLINDER: Schema = Schema {
    package: FOXGLOVE,
    name: "CylinderPrimitive",
    fields: &[
        ("pose", Kind::One(&POSE)),
        ("size", Kind::One(&VECTOR)),
        ("bottom_scale", Kind::Double),
        ("top_scale", Kind::Double),
        ("color", Kind::One(&COLOR)),
    ],
};
static MODEL: Schema = Schema {
    package: FOXGLOVE,
    name: "ModelPrimitive",
    fields: &[
        ("pose", Kind::One(&POSE)),
        ("scale", Kind::One(&VECTOR)),
        ("color", Kind::One(&COLOR)),
        ("override_color", Kind::Flag),
        ("url", Kind::Unused),
        ("media_type", Kind::Text),
        ("data", Kind::Bytes),
    ],
};
static SCENE_ENTITY: Schema = Schema {
    package: FOXGLOVE,
    name: "SceneEntity",
    fields: &[
        ("timestamp", Kind::One(&TIMESTAMP)),
        ("frame_id", Kind::Text),
        ("id", Kind::Text),
        ("lifetime", Kind::Unused),
        ("frame_locked", Kind::Flag),
        ("metadata", Kind::Unused),
        ("arrows", Kind::Unused),
        ("cubes", Kind::Many(&CUBE)),
        ("spheres", Kind::Many(&SPHERE)),
        ("cylinders", Kind::Many(&CYLINDER)),
        ("lines", Kind::Unused),
        ("triangles", Kind::Unused),
        ("texts", Kind::Unused),
        ("models", Kind::Many(&MODEL)),
    ],
};
static SCENE_ENTITY_DELETION: Schema = Schema {
    package: FOXGLOVE,
    name: "SceneEntityDeletion",
    fields: &[("timestamp", Kind::One(&TIMESTAMP)), ("type", Kind::Unused), ("id", Kind::Text)],
};

pub(super) static SCENE_UPDATE: Schema = Schema {
    package: FOXGLOVE,
    name: "SceneUpdate",
    fields: &[("deletions", Kind::Many(&SCENE_ENTITY_DELETION)), ("entities", Kind::Many(&SCENE_ENTITY))],
};
pub(super) static FRAME_TRANSFORMS: Schema =
    Schema { package: FOXGLOVE, name: "FrameTransforms", fields: &[("transforms", Kind::Many(&FRAME_TRANSFORM))] };
pub(super) static JOINT_STATES: Schema = Schema {
    package: FOXGLOVE,
    name: "JointStates",
    fields: &[("timestamp", Kind::One(&TIMESTAMP)), ("joints", Kind::Many(&JOINT_STATE))],
};
pub(super) static LOG: Schema = Schema {
    package: FOXGLOVE,
    name: "Log",
    fields: &[
        ("timestamp", Kind::One(&TIMESTAMP)),
        ("level", Kind::Level),
        ("message", Kind::Text),
        ("name", Kind::Text),
        ("file", Kind::Text),
        ("line", Kind::Fixed32),
    ],
};
pub(super) static CELL: Schema =
    Schema { package: OURS, name: "Cell", fields: &[("channels", Kind::Many(&RUNS)), ("names", Kind::Many(&NAME))] };
pub(super) static CHANNEL: Schema = Schema {
    package: OURS,
    name: "Channel",
    fields: &[
        ("time", Kind::Double),
        ("state", Kind::Text),
        ("file", Kind::Text),
        ("line", Kind::Uint32),
        ("motion_file", Kind::Text),
        ("motion_line", Kind::Uint32),
        ("motion", Kind::Uint64),
        ("axes", Kind::Doubles),
        ("tcp", Kind::Doubles),
        ("base", Kind::Doubles),
    ],
};
pub(super) static CONTROLLER: Schema = Schema {
    package: OURS,
    name: "Controller",
    fields: &[("time", Kind::Double), ("mode", Kind::Text), ("speed_override", Kind::Double)],
};
pub(super) static IO: Schema = Schema {
    package: OURS,
    name: "Io",
    fields: &[
        ("time", Kind::Double),
        ("di", Kind::Flags),
        ("do", Kind::Flags),
        ("ai", Kind::Doubles),
        ("ao", Kind::Doubles),
    ],
};
pub(super) static MOTION: Schema = Schema {
    package: OURS,
    name: "Motion",
    fields: &[
        ("channel", Kind::Uint32),
        ("motion", Kind::Uint64),
        ("line", Kind::Uint32),
        ("kind", Kind::Text),
        ("start", Kind::Double),
        ("duration", Kind::Double),
        ("way", Kind::Double),
        ("programmed", Kind::Double),
        ("reached", Kind::Double),
        ("unit", Kind::Text),
        ("blend", Kind::One(&BLEND)),
        ("closest_vel", Kind::One(&CLOSEST)),
        ("closest_acc", Kind::One(&CLOSEST)),
        ("closest_jerk", Kind::One(&CLOSEST)),
        ("file", Kind::Text),
    ],
};

pub(super) static CONTACT: Schema = Schema {
    package: OURS,
    name: "Contact",
    fields: &[
        ("time", Kind::Double),
        ("file", Kind::Text),
        ("line", Kind::Uint32),
        ("one", Kind::Text),
        ("other", Kind::Text),
        ("distance", Kind::Double),
    ],
};

/// `foxglove.Log.Level`, from 0 on.
const LEVELS: [&str; 6] = ["UNKNOWN", "DEBUG", "INFO", "WARNING", "ERROR", "FATAL"];

impl Schema {
    /// `foxglove.Log`
    pub(super) fn full_name(&self) -> String {
        format!("{}.{}", self.package, self.name)
    }

    /// A set of descriptors: that of the message, after those that it is made of.
    pub(super) fn descriptors(&self) -> Vec<u8> {
        let mut file = Vec::new();
        self.add_to(&mut file);
        FileDescriptorSet { file }.encode_to_vec()
    }

    /// Each message has a file of its own.
    fn file(&self) -> String {
        match self.package {
            "google.protobuf" => format!("google/protobuf/{}.proto", self.name.to_lowercase()),
            package => format!("{}/{}.proto", package.replace('.', "/"), self.name),
        }
    }

    fn add_to(&self, files: &mut Vec<FileDescriptorProto>) {
        if files.iter().any(|file| file.name() == self.file()) {
            return;
        }
        let parts: Vec<&Schema> = self.fields.iter().filter_map(|(_, kind)| kind.schema()).collect();
        parts.iter().for_each(|part| part.add_to(files));
        let mut dependency: Vec<String> = parts.iter().map(|part| part.file()).collect();
        dependency.sort();
        dependency.dedup();
        files.push(FileDescriptorProto {
            name: Some(self.file()),
            package: Some(self.package.into()),
            dependency,
            message_type: vec![self.message()],
            syntax: Some("proto3".into()),
            ..FileDescriptorProto::default()
        });
    }

    fn message(&self) -> DescriptorProto {
        let mut message = DescriptorProto { name: Some(self.name.into()), ..DescriptorProto::default() };
        let written = (1..).zip(self.fields).filter(|(_, (_, kind))| !matches!(kind, Kind::Unused));
        for (number, (name, kind)) in written {
            let mut field = kind.field(name, number);
            if let Kind::Maybe = kind {
                // An optional field is the only one of its group.
                field.oneof_index = i32::try_from(message.oneof_decl.len()).ok();
                field.proto3_optional = Some(true);
                let one = OneofDescriptorProto { name: Some(format!("_{name}")), ..OneofDescriptorProto::default() };
                message.oneof_decl.push(one);
            }
            if let Kind::Level = kind {
                field.type_name = Some(format!(".{}.Level", self.full_name()));
                message.enum_type.push(levels());
            }
            message.field.push(field);
        }
        message
    }
}

impl Kind {
    fn schema(&self) -> Option<&'static Schema> {
        match self {
            Self::One(schema) | Self::Many(schema) => Some(schema),
            _ => None,
        }
    }

    fn field(&self, name: &str, number: i32) -> FieldDescriptorProto {
        let (kind, label) = match self {
            Self::Double | Self::Maybe => (Type::Double, Label::Optional),
            Self::Doubles => (Type::Double, Label::Repeated),
            Self::Flag => (Type::Bool, Label::Optional),
            Self::Flags => (Type::Bool, Label::Repeated),
            Self::Text => (Type::String, Label::Optional),
            Self::Bytes => (Type::Bytes, Label::Optional),
            Self::Int32 => (Type::Int32, Label::Optional),
            Self::Int64 => (Type::Int64, Label::Optional),
            Self::Uint32 => (Type::Uint32, Label::Optional),
            Self::Uint64 => (Type::Uint64, Label::Optional),
            Self::Fixed32 => (Type::Fixed32, Label::Optional),
            Self::Level => (Type::Enum, Label::Optional),
            Self::One(_) => (Type::Message, Label::Optional),
            Self::Many(_) | Self::Unused => (Type::Message, Label::Repeated),
        };
        FieldDescriptorProto {
            name: Some(name.into()),
            number: Some(number),
            label: Some(label.into()),
            r#type: Some(kind.into()),
            type_name: self.schema().map(|schema| format!(".{}", schema.full_name())),
            ..FieldDescriptorProto::default()
        }
    }
}

fn levels() -> EnumDescriptorProto {
    let value = |(number, name): (i32, &&str)| EnumValueDescriptorProto {
        name: Some((*name).into()),
        number: Some(number),
        ..EnumValueDescriptorProto::default()
    };
    EnumDescriptorProto {
        name: Some("Level".into()),
        value: (0..).zip(&LEVELS).map(value).collect(),
        ..EnumDescriptorProto::default()
    }
}
