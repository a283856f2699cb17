//! Simplifies in a thread of its own, while the thread of the user interface shows how far it has come and
//! cancels.
//!
//! ```sh
//! cargo run --release --example cancel
//! ```

use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};
use std::thread;
use std::time::Duration;

use decimesh::mesh::shapes;
use decimesh::{Monitor, Options, SimplifyError, Target, simplify};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let stone = shapes::bumpy_sphere(200, 1);
    let is_cancelled = AtomicBool::new(false);
    let percent = AtomicU32::new(0);

    let outcome = thread::scope(|scope| {
        let worker = scope.spawn(|| {
            // Called in this thread, now and then; `Break` ends the work.
            let mut monitor = Monitor::new(|fraction| {
                percent.store((100.0 * fraction) as u32, Ordering::Relaxed);
                if is_cancelled.load(Ordering::Relaxed) {
                    ControlFlow::Break(())
                } else {
                    ControlFlow::Continue(())
                }
            });
            simplify(&stone, &Options::new(Target::Ratio(0.01)), &mut monitor)
        });

        // The loop of the user interface. This user runs out of patience as soon as there is progress to see.
        while !worker.is_finished() {
            thread::sleep(Duration::from_millis(1));
            let percent = percent.load(Ordering::Relaxed);
            if percent > 0 && !is_cancelled.swap(true, Ordering::Relaxed) {
                println!("{percent} % done; cancelling");
            }
        }
        worker.join()
    });

    match outcome.map_err(|_| "the worker panicked")? {
        Ok(result) => println!("it was faster: {} triangles", result.mesh.triangles().len()),
        Err(SimplifyError::Cancelled(_)) => println!("ended, as asked"),
        Err(error) => return Err(error.into()),
    }
    Ok(())
}
