// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// Program scheduler: starts the PEs' programs of the frames under way.
//
// A frame's first program gives its weights and the inputs of its search. With a field in the lanes, the second gives
// the residual stress. The third gives the field, once the search has found the friction. A program starts in the
// cycle after the last issue of the one before, if its data are there.

`default_nettype none

module sptfra_program_scheduler #(
    // Programs of a frame: 1, or 3 with a field that the lanes put together
    parameter PROGRAMS = 3,
    // Frames whose residual, what is left of the stress for the field, has a buffer: 1 or 2
    parameter integer RESIDUALS = 1,
    // Frames that have a buffer until they are released; 0: nothing of a frame stays
    parameter BUFFERS = 4,
    // 1: the next frame's first program goes ahead of a field whose search is not finished, best for the interval.
    // 0: it waits until this field is under way, best for the latency under load
    parameter INTERVAL = 1
) (
    input  wire clock,
    input  wire reset,
    // Data
    input  wire frame_ready, // a frame waits in its bank
    input  wire u_released, // one cycle: the buffer of a frame's u_q is free
    input  wire residual_written, // one cycle: the second program's results are there
    input  wire friction_known, // until the field is started
    input  wire frame_released, // one cycle: a frame has left
    // Lanes
    input  wire issued, // last issue of a program
    output reg  [PROGRAMS-1:0] start,
    output reg  bank, // of the stress of the frame started last
    output wire residual_bank, // of the residual that was started last
    output wire field_bank // of the residual whose field was
);

    if ((PROGRAMS < 1) || (PROGRAMS > 3)) begin : gen_check_programs
        sptfra_error_programs_must_be_1_to_3 invalid ();
    end
    if ((RESIDUALS < 1) || (RESIDUALS > 2)) begin : gen_check_residuals
        sptfra_error_one_or_two_residuals_have_a_buffer invalid ();
    end

    reg busy;
    // Frames started whose u_q has a buffer: two at most. A release comes from afar and is counted a cycle later
    reg [1:0] u_counted;
    reg released;
    wire [1:0] u_held = u_counted - {1'b0, released};
    reg [2:0] frames_held; // started and not released
    wire may_field;
    wire may_residual;
    wire field_waits; // and the next frame for it
    wire room = (BUFFERS == 0) || (frames_held != BUFFERS);
    wire may_frame = frame_ready && (u_held != 2'd2) && room && !field_waits;
    wire free = !busy || issued;

    always @(posedge clock) begin
        if (free) begin
            busy <= may_field || may_residual || may_frame;
        end
        start[0] <= free && may_frame && !may_field && !may_residual;
        if (free && may_frame && !may_field && !may_residual) begin
            bank <= !bank;
        end
        released <= u_released;
        u_counted <= u_held + {1'b0, start[0]};
        frames_held <= frames_held + {2'd0, start[0]} - {2'd0, frame_released};
        if (reset) begin
            start[0] <= 1'b0;
            busy <= 1'b0;
            bank <= 1'b1;
            u_counted <= 2'd0;
            released <= 1'b0;
            frames_held <= 3'd0;
        end
    end

    if (PROGRAMS == 3) begin : gen_field
        reg residual_due; // started, but for its second program
        reg [1:0] fields_due; // frames whose second program is started, but for their third
        reg [1:0] residuals_there; // of them
        reg next_residual_bank;
        reg next_field_bank;
        reg [1:0] fields_held; // field started and not released: two at most

        wire give_field = free && may_field;
        wire give_residual = free && !may_field && may_residual;

        assign may_field = (residuals_there != 2'd0) && friction_known && (fields_held != 2'd2);
        assign may_residual = residual_due && (fields_due != RESIDUALS[1:0]);
        assign field_waits = residual_due || ((INTERVAL == 0) && (fields_due != 2'd0));
        assign residual_bank = (RESIDUALS > 1) && next_residual_bank;
        assign field_bank = (RESIDUALS > 1) && next_field_bank;

        always @(posedge clock) begin
            start[2] <= give_field;
            start[1] <= give_residual;
            if (give_field) begin
                next_field_bank <= !next_field_bank;
            end
            if (give_residual) begin
                residual_due <= 1'b0;
                next_residual_bank <= !next_residual_bank;
            end else if (free && !may_field && may_frame) begin
                residual_due <= 1'b1;
            end
            fields_due <= fields_due + {1'b0, give_residual} - {1'b0, give_field};
            residuals_there <= residuals_there + {1'b0, residual_written} - {1'b0, give_field};
            fields_held <= fields_held + {1'b0, start[2]} - {1'b0, frame_released};
            if (reset) begin
                start[2:1] <= 2'd0;
                residual_due <= 1'b0;
                fields_due <= 2'd0;
                residuals_there <= 2'd0;
                next_residual_bank <= 1'b0;
                next_field_bank <= 1'b0;
                fields_held <= 2'd0;
            end
        end
    end else begin : gen_one_program
        assign may_field = 1'b0;
        assign may_residual = 1'b0;
        assign field_waits = 1'b0;
        assign residual_bank = 1'b0;
        assign field_bank = 1'b0;
        wire _unused = &{1'b0, residual_written, friction_known};
    end

endmodule

`default_nettype wire
