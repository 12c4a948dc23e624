//! Prints the table of the guide that flies the thesis's cases through standard air.

#[tokio::main(flavor = "current_thread")]
async fn main() {
    print!("{}", reentry_tests::standard_air::table().await);
}
