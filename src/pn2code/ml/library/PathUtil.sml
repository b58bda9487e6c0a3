(* Files that are looked for in folders. *)
structure PathUtil = struct
    fun existsFile has folders file =
        if OS.Path.isAbsolute file then if has file then SOME file else NONE
        else
            let fun look nil = NONE
                  | look (dir :: rest) =
                    let val path = OS.Path.joinDirFile {dir = dir, file = file}
                    in if has path then SOME path else look rest end
            in look folders end
    fun allFiles has folders file =
        if OS.Path.isAbsolute file then if has file then [file] else nil
        else
            let fun look (nil, found) = rev found
                  | look (dir :: rest, found) =
                    let val path = OS.Path.joinDirFile {dir = dir, file = file}
                    in look (rest, if has path then path :: found else found) end
            in look (folders, nil) end
    fun isThere path = OS.FileSys.access (path, nil)
    fun findFile folders file = existsFile isThere folders file
    fun findFiles folders file = allFiles isThere folders file
    fun findExe folders file = existsFile (fn path => OS.FileSys.access (path, [OS.FileSys.A_EXEC])) folders file
end
