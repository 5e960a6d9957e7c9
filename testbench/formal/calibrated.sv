// SPDX-License-Identifier: MIT OR Apache-2.0
//
// Banks of a calibration in RAM: a frame reads the bank that is active at its first beat until it has left, no other
// frame begins meanwhile, and a tare takes it whole or not at all.
//
// Assumed of the banks' control: it writes the bank that is not active, and changes banks, only while no frame needs the
// other one. Assumed of sptfra_replace, which has a proof of its own: it is busy from a frame's last reading in to its
// last one out.
module harness (
    input wire clock,
    input wire [31:0] s_tdata,
    input wire s_tlast,
    input wire s_tvalid,
    input wire write_ready,
    input wire cean_idle,
    input wire direction_room,
    input wire tare_run,
    input wire change,
    input wire writes,
    input wire written_bank
);

    localparam STAGES = 11;

    reg started = 1'b0;
    reg active = 1'b0;
    wire reset = !started;
    wire s_tready;
    wire frame_done;
    wire old_in_use;
    wire frame_calibrates;
    wire bank;
    wire bank_held;
    wire in_frame;
    wire may_open;
    wire marked;
    wire replace_busy;
    wire whole_takes;
    wire whole_ends;
    wire [STAGES:1] valid;
    wire [STAGES:1] lasts;

    sptfra_bz subject (
        .clock                  (clock),
        .reset                  (reset),
        .s_tdata                (s_tdata),
        .s_tlast                (s_tlast),
        .s_tvalid               (s_tvalid),
        .s_tready               (s_tready),
        .write_ready            (write_ready),
        .cean_idle              (cean_idle),
        .direction_room         (direction_room),
        .frame_done             (frame_done),
        .active_calibration     ({active, 67'd0}),
        .calibration_old_in_use (old_in_use),
        .tare_command           ({tare_run, 8'd0}),
        .frame_calibrates       (frame_calibrates),
        // Inside
        .bank         (bank),
        .bank_held    (bank_held),
        .in_frame     (in_frame),
        .replace_busy (replace_busy),
        .\gate.may_open (may_open),
        .\gate.valid (valid),
        .\gate.lasts (lasts),
        .\writer.takes (whole_takes),
        .\writer.ends (whole_ends),
        .\gen_calibration.banks.marked (marked)
    );

    // ---- The frame inside, and what was active at its first beat
    wire taken = s_tvalid && s_tready;
    wire arrives = valid[STAGES] && lasts[STAGES];
    reg open; // its last beat has not come in
    reg kept; // it has not left
    reg replaces; // its last reading has come, and not gone out
    reg its_bank;
    reg its_mark;

    always @(posedge clock) begin
        started <= 1'b1;
        active <= active ^ change;
        if (frame_done) begin
            kept <= 1'b0;
        end
        if (taken) begin
            open <= !s_tlast;
            kept <= 1'b1;
            its_bank <= open ? its_bank : active;
            its_mark <= open ? its_mark : tare_run;
        end
        if (!tare_run) begin
            its_mark <= 1'b0;
        end
        replaces <= arrives || (replaces && !frame_done);
        if (reset) begin
            open <= 1'b0;
            kept <= 1'b0;
            replaces <= 1'b0;
        end
    end

    always @(*) begin
        assume (!change || !old_in_use);
        assume (!writes || (!old_in_use && (written_bank != active)));
        assume (replace_busy == replaces);
        assume (!(whole_takes || whole_ends) || replaces);
    end

    always @(posedge clock) begin
        if (!reset) begin
            // One bank for a frame, from its first beat on, and one frame at a time
            assert (!taken || (bank == (open ? its_bank : active)));
            assert (!kept || (bank_held == its_bank));
            assert (frame_calibrates == (taken && !open));
            assert (!(frame_calibrates && kept));
            // What it needs is not written
            assert (!(writes && kept && (written_bank == its_bank)));
            assert (old_in_use == (kept && (its_bank != active)));
            // A tare has it whole or not at all
            assert (!kept || (marked == its_mark));
        end
    end

`ifdef INVARIANTS
    integer stage;
    integer before;

    always @(posedge clock) begin
        if (!reset) begin
            assert (in_frame == open);
            assert (kept == (open || (valid != {STAGES{1'b0}}) || replaces));
            assert (!((valid != {STAGES{1'b0}}) || replaces) || !may_open);
            assert (!replaces || (!open && (valid == {STAGES{1'b0}})));
            assert (open || replaces || !kept || ((valid & lasts) != {STAGES{1'b0}}));
            for (stage = 1; stage <= STAGES; stage = stage + 1) begin
                if (valid[stage] && lasts[stage]) begin
                    assert (!open);
                    for (before = 1; before < stage; before = before + 1) begin
                        assert (!valid[before]);
                    end
                end
            end
        end
    end
`endif

endmodule
