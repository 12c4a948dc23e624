//! Prints the table of the README that sets the theories beside the simulation.

#[tokio::main(flavor = "current_thread")]
async fn main() {
    print!("{}", reentry_tests::theory::table().await);
}
