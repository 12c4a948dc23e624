//! Prints the table of the guide that sets the theories beside the simulation.

#[tokio::main(flavor = "current_thread")]
async fn main() {
    print!("{}", reentry_tests::theory::table().await);
}
