//! Copies of the state as arrays.

use ndda_solver::{Sample, Simulation};
use numpy::{Element, PyArray1, PyArray2, PyArrayMethods, PyReadwriteArray2};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

/// A read-only array of rows.
pub fn rows<'py, T: Element, const N: usize>(
    py: Python<'py>,
    rows: Vec<[T; N]>,
) -> PyResult<Bound<'py, PyArray2<T>>> {
    let count = rows.len();
    let array = PyArray1::from_vec(py, rows.into_flattened()).reshape([count, N])?;
    array.call_method1("setflags", (false,))?;
    Ok(array)
}

/// Mass centre of each block \[m\].
pub fn centers(simulation: &Simulation) -> Vec<[f64; 3]> {
    let (blocks, position) = (simulation.blocks(), &simulation.state().position);
    let center = |block| {
        let own = &position[blocks.nodes_of(block)];
        (simulation.shape(block).operator.center(own) + blocks.origin_m).into()
    };
    blocks.ids().map(center).collect()
}

/// Mass of each block \[kg\].
pub fn masses_kg(simulation: &Simulation) -> Vec<f64> {
    simulation.blocks().ids().map(|block| simulation.shape(block).operator.mass_kg).collect()
}

/// First tetrahedron of each block, and the number of tetrahedra at the end.
pub fn tet_starts(simulation: &Simulation) -> Vec<usize> {
    let blocks = simulation.blocks();
    blocks.ids().map(|block| blocks.tets_of(block).start).chain([blocks.tets.len()]).collect()
}

/// Nodes of each tetrahedron.
pub fn tetrahedra(simulation: &Simulation) -> Vec<[i64; 4]> {
    simulation.blocks().tets.iter().map(|tet| tet.map(|node| i64::from(node.0))).collect()
}

/// A quantity of the nodes in global coordinates, passed to `take` row by row.
pub fn each_node(simulation: &Simulation, name: &str, mut take: impl FnMut(usize, [f64; 3])) -> PyResult<()> {
    let (state, origin) = (simulation.state(), simulation.blocks().origin_m);
    let start = simulation.start_position();
    for (i, x) in state.position.iter().enumerate() {
        let value = match name {
            "position" => x + origin,
            "displacement" => x - start[i],
            "velocity" => state.velocity[i],
            "acceleration" => state.acceleration[i],
            _ => return Err(unknown(name)),
        };
        take(i, value.into());
    }
    Ok(())
}

fn unknown(name: &str) -> PyErr {
    let known = "position, displacement, velocity, acceleration";
    PyValueError::new_err(format!("nodes have no quantity {name:?}: choose one of {known}"))
}

/// Writes a quantity of the nodes to an array of the caller's, allocating nothing.
pub fn fill(simulation: &Simulation, name: &str, out: &mut PyReadwriteArray2<'_, f64>) -> PyResult<()> {
    let (nodes, mut view) = (simulation.state().position.len(), out.as_array_mut());
    if view.dim() != (nodes, 3) {
        let (rows, columns) = view.dim();
        return Err(PyValueError::new_err(format!(
            "`out` has shape ({rows}, {columns}): make it ({nodes}, 3)"
        )));
    }
    each_node(simulation, name, |i, value| (0..3).for_each(|axis| view[[i, axis]] = value[axis]))
}

/// Number of energies and works of a sample.
const ENERGIES: usize = 15;

/// Energies and works with their names [J].
pub fn energies(sample: &Sample) -> [(&'static str, f64); ENERGIES] {
    [
        ("kinetic_j", sample.kinetic_j),
        ("strain_j", sample.strain_j),
        ("contact_j", sample.contact_j),
        ("load_j", sample.load_j),
        ("spring_j", sample.spring_j),
        ("total_j", sample.total_j()),
        ("friction_work_j", sample.friction_work_j),
        ("motion_work_j", sample.motion_work_j),
        ("load_work_j", sample.load_work_j),
        ("damping_work_j", sample.damping_work_j),
        ("restitution_work_j", sample.restitution_work_j),
        ("radiated_j", sample.radiated_j),
        ("bolt_j", sample.bolt_j),
        ("bolt_work_j", sample.bolt_work_j),
        ("balance_j", sample.balance_j),
    ]
}

/// Time and energies of a sample.
pub fn sample_row(sample: &Sample) -> [f64; ENERGIES + 1] {
    let mut row = [sample.time_s; ENERGIES + 1];
    row[1..].copy_from_slice(&energies(sample).map(|(_, value)| value));
    row
}

/// Names of the values of a [`sample_row`].
pub fn row_names() -> [&'static str; ENERGIES + 1] {
    let mut names = ["time_s"; ENERGIES + 1];
    names[1..].copy_from_slice(&energies(&Sample::default()).map(|(name, _)| name));
    names
}
