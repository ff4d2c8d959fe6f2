//! Results as a Parquet file: a column for each parameter and each figure.

use super::result::{Collision, Row};
use arl_robot::result_file::ResultFile;
use parquet::basic::{LogicalType, Repetition, Type as Physical};
use parquet::data_type::{BoolType, ByteArray, ByteArrayType, DataType, DoubleType, Int64Type};
use parquet::errors::Result;
use parquet::file::properties::WriterProperties;
use parquet::file::writer::{SerializedFileWriter, SerializedRowGroupWriter};
use parquet::schema::types::{Type, TypePtr};
use serde_json::Value;
use std::sync::Arc;

/// The values of a column, with gaps.
enum Column {
    Whole(Vec<Option<i64>>),
    Number(Vec<Option<f64>>),
    Truth(Vec<Option<bool>>),
    Text(Vec<Option<String>>),
}

/// Writes the rows into a file.
///
/// # Errors
/// The file cannot be written.
pub(super) fn write(file: ResultFile, rows: &[Row]) -> Result<()> {
    let columns = columns(rows);
    let fields: Result<Vec<TypePtr>> = columns.iter().map(|(name, column)| field(name, column)).collect();
    let schema = Type::group_type_builder("results").with_fields(fields?).build()?;
    let (schema, properties) = (Arc::new(schema), Arc::new(WriterProperties::builder().build()));
    let mut bytes = Vec::new();
    let mut writer = SerializedFileWriter::new(&mut bytes, schema, properties)?;
    let mut group = writer.next_row_group()?;
    for (_, column) in &columns {
        match column {
            Column::Whole(values) => put::<Int64Type>(&mut group, values.iter().copied())?,
            Column::Number(values) => put::<DoubleType>(&mut group, values.iter().copied())?,
            Column::Truth(values) => put::<BoolType>(&mut group, values.iter().copied())?,
            Column::Text(values) => {
                put::<ByteArrayType>(&mut group, values.iter().map(|value| value.as_deref().map(ByteArray::from)))?;
            }
        }
    }
    group.close()?;
    writer.close()?;
    Ok(file.replace(&bytes)?)
}

fn put<T: DataType>(
    group: &mut SerializedRowGroupWriter<'_, &mut Vec<u8>>,
    values: impl Iterator<Item = Option<T::T>>,
) -> Result<()> {
    let Some(mut column) = group.next_column()? else { return Ok(()) };
    let values: Vec<Option<T::T>> = values.collect();
    let levels: Vec<i16> = values.iter().map(|value| i16::from(value.is_some())).collect();
    let there: Vec<T::T> = values.into_iter().flatten().collect();
    column.typed::<T>().write_batch(&there, Some(&levels), None)?;
    column.close()
}

fn field(name: &str, column: &Column) -> Result<TypePtr> {
    let (physical, logical) = match column {
        Column::Whole(_) => (Physical::INT64, None),
        Column::Number(_) => (Physical::DOUBLE, None),
        Column::Truth(_) => (Physical::BOOLEAN, None),
        Column::Text(_) => (Physical::BYTE_ARRAY, Some(LogicalType::String)),
    };
    let builder = Type::primitive_type_builder(name, physical).with_repetition(Repetition::OPTIONAL);
    Ok(Arc::new(builder.with_logical_type(logical).build()?))
}

fn columns(rows: &[Row]) -> Vec<(String, Column)> {
    let mut columns = vec![("run".to_owned(), Column::Whole(rows.iter().map(|row| Some(row.run as i64)).collect()))];
    let mut names: Vec<&str> = Vec::new();
    for row in rows {
        for (name, _) in &row.parameters.0 {
            if !names.contains(&name.as_str()) {
                names.push(name);
            }
        }
    }
    columns.extend(names.into_iter().map(|name| (name.to_owned(), parameter(rows, name))));
    let number = |of: fn(&Row) -> Option<f64>| Column::Number(rows.iter().map(of).collect());
    let whole = |of: fn(&Row) -> Option<i64>| Column::Whole(rows.iter().map(of).collect());
    let text = |of: fn(&Row) -> Option<String>| Column::Text(rows.iter().map(of).collect());
    columns.extend([
        ("outcome".to_owned(), text(|row| Some(row.result.outcome.clone()))),
        ("code".to_owned(), whole(|row| row.result.code.map(i64::from))),
        ("cycle_time".to_owned(), number(|row| row.result.cycle_time)),
        ("moving".to_owned(), number(|row| row.result.moving)),
        ("standing".to_owned(), number(|row| row.result.standing)),
        ("motions".to_owned(), whole(|row| row.result.motions.map(|motions| motions as i64))),
        ("way".to_owned(), number(|row| row.result.way)),
        ("alarm_number".to_owned(), whole(|row| row.result.alarms.first().map(|alarm| i64::from(alarm.number)))),
        ("alarm_text".to_owned(), text(|row| row.result.alarms.first().map(|alarm| alarm.text.clone()))),
        ("alarm_file".to_owned(), text(|row| row.result.alarms.first().map(|alarm| alarm.file.clone()))),
        ("alarm_line".to_owned(), whole(|row| row.result.alarms.first().map(|alarm| i64::from(alarm.line)))),
        ("collisions".to_owned(), whole(|row| Some(row.result.collisions.as_ref()?.len() as i64))),
        ("collision_time".to_owned(), number(|row| Some(first_collision(row)?.time))),
        ("collision_file".to_owned(), text(|row| Some(first_collision(row)?.file.clone()))),
        ("collision_line".to_owned(), whole(|row| Some(i64::from(first_collision(row)?.line)))),
        ("collision_bodies".to_owned(), text(|row| Some(first_collision(row)?.bodies.join(", ")))),
        ("collision_distance".to_owned(), number(|row| Some(first_collision(row)?.distance))),
        ("output".to_owned(), text(|row| Some(row.result.output.join("\n")))),
        ("problem".to_owned(), text(|row| row.result.problem.clone())),
    ]);
    columns
}

fn first_collision(row: &Row) -> Option<&Collision> {
    row.result.collisions.as_ref()?.first()
}

/// The column of a parameter: numbers or truth values where all are such, else texts.
fn parameter(rows: &[Row], name: &str) -> Column {
    let values = || rows.iter().map(|row| row.parameters.option(name));
    let all = |is: fn(&Value) -> bool| values().flatten().all(is);
    if all(Value::is_i64) {
        Column::Whole(values().map(|value| value?.as_i64()).collect())
    } else if all(Value::is_number) {
        Column::Number(values().map(|value| value?.as_f64()).collect())
    } else if all(Value::is_boolean) {
        Column::Truth(values().map(|value| value?.as_bool()).collect())
    } else {
        let text = |value: &Value| value.as_str().map_or_else(|| value.to_string(), str::to_owned);
        Column::Text(values().map(|value| value.map(text)).collect())
    }
}
