//! Folders written, and what is left alone.

use super::*;

fn files(names: &[&str]) -> FileMap {
    names.iter().map(|name| ((*name).to_owned(), name.as_bytes().to_vec())).collect()
}

#[test]
fn replaces_its_own_files_and_leaves_no_old_ones() {
    let place = tempfile::tempdir().unwrap();
    let folder = place.path().join("out");
    write_folder(&folder, &files(&["rtl/a.v", "rom/b.mem"])).unwrap();
    write_folder(&folder, &files(&["rtl/c.v"])).unwrap();
    assert!(folder.join("rtl/c.v").exists() && !folder.join("rtl/a.v").exists());
    assert_eq!(fs::read_dir(place.path()).unwrap().count(), 1, "nothing is left beside the folder");
}

#[test]
fn leaves_the_users_files_alone() {
    let place = tempfile::tempdir().unwrap();
    let folder = place.path().join("out");
    write_folder(&folder, &files(&["rtl/a.v"])).unwrap();
    fs::write(folder.join("rtl/mine.v"), "mine").unwrap();
    let error = write_folder(&folder, &files(&["rtl/c.v"])).unwrap_err().to_string();
    assert!(error.contains("rtl/mine.v, which `sptfra generate` did not write"), "{error}");
    assert_eq!(fs::read_to_string(folder.join("rtl/mine.v")).unwrap(), "mine");
    assert!(folder.join("rtl/a.v").exists() && !folder.join("rtl/c.v").exists());
}

#[test]
fn leaves_the_users_empty_folders_alone() {
    let place = tempfile::tempdir().unwrap();
    for (mine, named) in [("mine", "mine/"), ("rtl/empty", "rtl/empty/"), ("a/b", "a/b/")] {
        let folder = place.path().join(mine.replace('/', "-"));
        write_folder(&folder, &files(&["rtl/a.v"])).unwrap();
        fs::create_dir_all(folder.join(mine)).unwrap();
        let error = write_folder(&folder, &files(&["rtl/c.v"])).unwrap_err().to_string();
        assert!(error.contains(&format!("holds {named}, which `sptfra generate` did not write")), "{error}");
        assert!(folder.join(mine).is_dir() && folder.join("rtl/a.v").exists());
    }
}

#[test]
fn what_a_killed_one_left_is_removed() {
    let place = tempfile::tempdir().unwrap();
    let of = |name: &str, staged: &str| {
        let prefix = staging_prefix(&place.path().join(name));
        let left = place.path().join(prefix + "abcdef").join(staged);
        fs::create_dir_all(&left).unwrap();
        fs::write(left.join("a.v"), "half").unwrap();
        left
    };
    let folder = place.path().join("out");
    let [half, other] = [("out", "new"), ("out-two", "new")].map(|(name, staged)| of(name, staged));
    write_folder(&folder, &files(&["rtl/a.v"])).unwrap();
    assert!(!half.parent().unwrap().exists(), "half a design");
    assert!(other.exists(), "another output's");
    // The only copy of a former design, and one into which a file came meanwhile.
    for staged in ["old", "new"] {
        let kept = of("out", staged);
        fs::write(kept.join(MANIFEST), "").unwrap();
        write_folder(&folder, &files(&["rtl/a.v"])).unwrap();
        assert!(kept.join("a.v").exists(), "{staged}");
        fs::remove_dir_all(kept.parent().unwrap()).unwrap();
    }
}

#[test]
fn leaves_the_users_changes_alone() {
    let place = tempfile::tempdir().unwrap();
    let folder = place.path().join("out");
    write_folder(&folder, &files(&["rtl/a.v", "rtl/b.v"])).unwrap();
    fs::write(folder.join("rtl/b.v"), "better").unwrap();
    let error = write_folder(&folder, &files(&["rtl/b.v"])).unwrap_err().to_string();
    assert!(error.contains("rtl/b.v, which was changed after"), "{error}");
    assert_eq!(fs::read_to_string(folder.join("rtl/b.v")).unwrap(), "better");
    assert!(folder.join("rtl/a.v").exists());
}

#[test]
fn takes_a_folder_that_is_empty_or_lacks_files() {
    let place = tempfile::tempdir().unwrap();
    let folder = place.path().join("out");
    fs::create_dir(&folder).unwrap();
    write_folder(&folder, &files(&["rtl/a.v", "rtl/b.v"])).unwrap();
    fs::remove_file(folder.join("rtl/b.v")).unwrap();
    write_folder(&folder, &files(&["rtl/a.v", "rtl/b.v"])).unwrap();
    assert!(folder.join("rtl/b.v").exists());
}

#[cfg(unix)]
#[test]
fn follows_a_link_and_leaves_it() {
    let place = tempfile::tempdir().unwrap();
    let (real, link) = (place.path().join("real"), place.path().join("link"));
    fs::create_dir(&real).unwrap();
    std::os::unix::fs::symlink(&real, &link).unwrap();
    write_folder(&link, &files(&["rtl/a.v"])).unwrap();
    assert!(link.is_symlink() && real.join("rtl/a.v").exists());
}

#[test]
fn a_write_that_fails_midway_leaves_the_old_folder() {
    let place = tempfile::tempdir().unwrap();
    let folder = place.path().join("out");
    write_folder(&folder, &files(&["rtl/a.v"])).unwrap();
    // A file where a later one needs a folder.
    let error = write_folder(&folder, &files(&["rtl/c.v", "rtl/c.v/d.v"])).unwrap_err().to_string();
    assert!(error.contains("rtl/c.v"), "{error}");
    assert!(folder.join("rtl/a.v").exists() && !folder.join("rtl/c.v").exists());
    assert_eq!(fs::read_dir(place.path()).unwrap().count(), 1, "nothing is left beside the folder");
}

/// A reader looks all the time while the folder changes hands.
#[cfg(target_os = "linux")]
#[test]
fn there_is_no_moment_without_a_folder() {
    use std::sync::atomic::{AtomicBool, Ordering};

    let place = tempfile::tempdir().unwrap();
    let folder = place.path().join("out");
    write_folder(&folder, &files(&["id", "old"])).unwrap();
    let over = AtomicBool::new(false);
    let looks = std::thread::scope(|scope| {
        let reader = scope.spawn(|| {
            let mut looks = 0;
            while !over.load(Ordering::Relaxed) {
                assert_eq!(fs::read_to_string(folder.join("id")).ok().as_deref(), Some("id"), "look {looks}");
                looks += 1;
            }
            looks
        });
        for round in 0..200 {
            write_folder(&folder, &files(&["id", if round % 2 == 0 { "new" } else { "old" }])).unwrap();
        }
        over.store(true, Ordering::Relaxed);
        reader.join().unwrap()
    });
    assert!(looks > 100, "{looks}");
}

#[test]
fn several_at_once_do_not_mix() {
    let place = tempfile::tempdir().unwrap();
    for round in 0..30 {
        let folder = place.path().join(format!("out{}", round % 3));
        let sets: Vec<FileMap> =
            (0..4).map(|writer| files(&[&format!("a/{writer}"), &format!("b/{writer}")])).collect();
        std::thread::scope(|scope| {
            for set in &sets {
                scope.spawn(|| write_folder(&folder, set).unwrap());
            }
        });
        let found: Vec<String> = ["a", "b"]
            .map(|part| {
                let mut names = fs::read_dir(folder.join(part)).unwrap();
                let name = names.next().unwrap().unwrap().file_name().into_string().unwrap();
                assert!(names.next().is_none());
                name
            })
            .to_vec();
        assert_eq!(found[0], found[1], "files of one writer");
        check_folder(&folder).unwrap();
    }
    assert_eq!(fs::read_dir(place.path()).unwrap().count(), 3, "nothing is left beside the folders");
}

#[test]
fn a_file_that_came_in_meanwhile_is_given_back() {
    let place = tempfile::tempdir().unwrap();
    let folder = place.path().join("out");
    write_folder(&folder, &files(&["rtl/a.v"])).unwrap();
    let staging = tempfile::tempdir_in(place.path()).unwrap();
    let fresh = staging.path().join("new");
    fs::create_dir(&fresh).unwrap();
    // After the check and before the swap.
    fs::write(folder.join("mine"), "mine").unwrap();
    let error = swap::into_place(&fresh, &folder, staging).unwrap_err().to_string();
    assert!(error.contains("mine, which `sptfra generate` did not write"), "{error}");
    assert!(folder.join("mine").exists() && folder.join("rtl/a.v").exists());
}

#[test]
fn the_manifest_lists_every_file() {
    let place = tempfile::tempdir().unwrap();
    let folder = place.path().join("out");
    write_folder(&folder, &files(&["abc", "rtl/a.v"])).unwrap();
    let manifest = fs::read_to_string(folder.join(MANIFEST)).unwrap();
    let first = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad  abc";
    assert_eq!((manifest.lines().next(), manifest.lines().count()), (Some(first), 2));
}

#[test]
fn says_when_the_place_is_no_folder() {
    let place = tempfile::tempdir().unwrap();
    let path = place.path().join("file");
    fs::write(&path, "").unwrap();
    assert!(matches!(write_folder(&path, &files(&["a"])), Err(WriteError::NotAFolder(_))));
    let below = path.join("deeper");
    assert!(matches!(write_folder(&below, &files(&["a"])), Err(WriteError::Io { .. })));
}
