//! The order of functions: each after those it calls, as its own text names them. So it does not
//! matter in which order they were made, by the program or ahead with the library.

use crate::graph::{Function, FunctionId, Graph};

/// Puts the functions that the entry reaches into the order of a walk from it, callees first.
pub fn run(graph: Graph) -> Graph {
    let Some(entry) = graph.functions.len().checked_sub(1) else { return graph };
    let mut places: Vec<Option<FunctionId>> = vec![None; graph.functions.len()];
    let mut order = Vec::with_capacity(graph.functions.len());
    let callees = |place: usize| {
        let called: Vec<FunctionId> = graph.functions[place].functions().collect();
        called.into_iter()
    };
    let mut open = vec![(entry, callees(entry))];
    while let Some((place, left)) = open.last_mut() {
        match left.next() {
            // A graph has no recursion, so what has no place yet is not open either.
            Some(next) if places[next.0 as usize].is_none() => {
                let next = next.0 as usize;
                open.push((next, callees(next)));
            }
            Some(_) => {}
            None => {
                places[*place] = Some(FunctionId(order.len() as u32));
                order.push(*place);
                open.pop();
            }
        }
    }
    let mut functions: Vec<Option<Function>> = graph.functions.into_iter().map(Some).collect();
    let arranged = order.into_iter().filter_map(|place| {
        let mut function = functions[place].take()?;
        function.replace_functions(|id| places[id.0 as usize].unwrap_or(id));
        Some(function)
    });
    Graph { functions: arranged.collect(), ..graph }
}
