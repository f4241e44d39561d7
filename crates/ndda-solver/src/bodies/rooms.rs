//! Memory that congruent blocks work in, one run of them after the other.
//!
//! Apart from its nodes and what it [keeps](Kept), the step of a block reads nothing that it has not written itself. So where many blocks have one
//! shape, each thread has one set of working memory, which is lent to a run of these blocks for their step.

use std::mem::{replace, take};
use std::sync::{Mutex, MutexGuard};

use crate::bodies::batch::{Batch, ENOUGH_TOGETHER};
use crate::bodies::body::{Body, Motion};
use crate::bodies::elastic_body::{ElasticBody, Kept};
use crate::bodies::prototype::Prototype;

/// Blocks of one shape from which on they have no memory of their own.
pub(crate) const MANY: usize = 16;

/// Memory for blocks of one shape.
pub(crate) struct Rooms {
    of_thread: Vec<Mutex<Room>>,
}

/// Memory for one run.
#[derive(Default)]
struct Room {
    #[allow(clippy::vec_box)] // they go from here into blocks and back as they are
    bodies: Vec<Box<ElasticBody>>,
    batch: Option<Box<Batch>>,
}

impl Rooms {
    /// For the threads that there are now; more have to share.
    pub(crate) fn new() -> Self {
        Self { of_thread: (0..rayon::current_num_threads()).map(|_| Mutex::default()).collect() }
    }

    /// Makes blocks find memory for the factors that their shape has now.
    pub(crate) fn renew(&mut self) {
        self.of_thread.iter_mut().for_each(|room| *room = Mutex::default());
    }

    fn of_this_thread(&self) -> Option<MutexGuard<'_, Room>> {
        let thread = rayon::current_thread_index().unwrap_or(0) % self.of_thread.len();
        // A thread that waits inside a step for others may take up another run; that one brings memory of its own.
        self.of_thread[thread].try_lock().ok()
    }
}

/// A run of blocks, with memory to work in.
pub(crate) struct Guests<'a> {
    run: &'a mut [Body],
    room: Option<MutexGuard<'a, Room>>,
    /// Whether they have to leave.
    are_guests: bool,
}

impl<'a> Guests<'a> {
    /// Lets the blocks of a run in that have no memory of their own.
    pub(crate) fn enter(shape: &Prototype, rooms: Option<&'a Rooms>, run: &'a mut [Body]) -> Self {
        let Some(rooms) = rooms else { return Self { run, room: None, are_guests: false } };
        let mut room = rooms.of_this_thread();
        for body in run.iter_mut() {
            let Motion::Resting(kept) = &mut body.motion else { continue };
            let kept = take(kept);
            body.motion = Motion::Elastic(match room.as_mut().and_then(|room| room.bodies.pop()) {
                Some(mut memory) => {
                    memory.kept = kept;
                    memory
                }
                None => Box::new(ElasticBody::new(shape, kept)),
            });
        }
        if let Some(factor) = shape.factor.as_deref().filter(|_| run.len() >= ENOUGH_TOGETHER) {
            let batch = room.as_mut().and_then(|room| room.batch.take());
            run[0].batch = Some(batch.unwrap_or_else(|| Box::new(Batch::new(factor))));
        }
        // Without a room of the thread, what is made here is dropped in the end.
        Self { run, room, are_guests: true }
    }

    /// The blocks.
    pub(crate) fn run(&mut self) -> &mut [Body] {
        self.run
    }

    /// The only block of a run of one.
    pub(crate) fn one(&mut self) -> &mut Body {
        &mut self.run[0]
    }
}

impl Drop for Guests<'_> {
    fn drop(&mut self) {
        if !self.are_guests {
            return;
        }
        for body in self.run.iter_mut() {
            match replace(&mut body.motion, Motion::Resting(Kept::default())) {
                Motion::Elastic(mut memory) => {
                    body.motion = Motion::Resting(take(&mut memory.kept));
                    if let Some(room) = &mut self.room {
                        room.bodies.push(memory);
                    }
                }
                other => body.motion = other,
            }
        }
        let batch = self.run.first_mut().and_then(|first| first.batch.take());
        if let (Some(room), Some(batch)) = (&mut self.room, batch) {
            room.batch = Some(batch);
        }
    }
}
