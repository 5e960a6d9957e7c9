// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// The words before the field of a frame of several bodies: 16, then 8 for each of CONTACTS records, the body that
// presses most first.
//
// A record: taxels in bits 15:0 and status bits in 31:16; centre x, y; F_x, F_y, F_z; mu; standard error. Those of
// bodies that are not there are zeros. The words come from the headers of the core's answers: of the frame as solved
// in one piece (body 8), and of each body in the last round and, forces along x and y alone, the round before. They
// are written before start, none from then until done. What is done with them is a program (sptfra_records_control):
// with no body kept the frame's words stay as they are, with one that is the frame, with more the frame is their sum.
//
// With a limit of friction the program also finds which bodies slip: each by the limit of the one that was nearest in
// the last frame, a lower one if that slipped. A frame without contact ends that, one that tells nothing does not.
//
// Memory: sixteen words for each body, the frame, and what is between; four of each body for the next frame. In a
// body's page words 14 and 15 are F_x and F_y of the round before, and words that records have no use for are written
// over. Two banks of results: a frame's words stay until the next start but one.
//
// From start to done a fixed number of cycles for each number of bodies kept, LATENCIES. Read: 1 cycle.

`default_nettype none

module sptfra_records #(
    // Records, 2 to 8
    parameter integer CONTACTS = 4,
    // Middle of the grid from the first taxel in metres, float32 as all below
    parameter [31:0] MIDDLE_X = 32'h3c1374bc,
    parameter [31:0] MIDDLE_Y = 32'h3c1374bc,
    // The square of the share of what the last round has changed that counts as error
    parameter [31:0] CHANGE_SQUARED = 32'h3fc80000,
    // 1 over the square of the length within which bodies feel each other
    parameter [31:0] NEARNESS = 32'h47742400,
    // A standard error above so many |F_z| is doubtful
    parameter [31:0] LIMIT = 32'h3d75c28f,
    // Friction from which on a body slips, and at which it still does if it did before, for programs that ask
    parameter [31:0] SLIPS_FROM = 32'd0,
    parameter [31:0] SLIPS_STILL = 32'd0,
    // Instructions of the program
    parameter integer PROGRAM_LENGTH = 128,
    // Prefix of the program's file name, for instance a directory with its slash
    parameter ROM_DIR = "",
    // The program
    parameter FILE = "",
    // Cycles from start to done, 16 bits for each number of bodies kept, 0 first; checked in simulation, 0: unchecked
    parameter [16*(CONTACTS+1)-1:0] LATENCIES = {(16 * (CONTACTS + 1)){1'b0}},
    // Bits of a word's place in a bank; follows from CONTACTS
    parameter integer OUT_WIDTH = $clog2(16 + 8 * CONTACTS)
) (
    input  wire clock,
    input  wire reset,
    // Headers
    input  wire in_write,
    input  wire [3:0] in_body, // 8: the frame
    input  wire in_before, // of the round before
    input  wire [3:0] in_word,
    input  wire [31:0] in_data,
    // A frame
    input  wire start, // with these
    input  wire [3:0] kept, // bodies with a record, at most CONTACTS
    input  wire [7:0] bodies, // all that there are
    input  wire [16*CONTACTS-1:0] taxels, // that each of the first touches
    input  wire saturated, // a number did not fit on the way
    output wire done, // one cycle
    // Its words
    output reg  out_bank, // of the last frame that is done, from done on
    input  wire [OUT_WIDTH:0] out_address, // the bank on top
    output wire [31:0] out_word // one cycle later
);

    // Places of sources and destinations
    localparam [2:0] OF_I = 3'd0, OF_J = 3'd1, OF_FRAME = 3'd2, CONSTANT = 3'd4, OUT_FRAME = 3'd5, OUT_RECORD = 3'd6;
    localparam [2:0] LAST = 3'd7; // as a source of j, as a destination of i
    localparam [3:0] FRAME_PAGE = 4'd8, SCRATCH_PAGE = 4'd9;
    localparam [2:0] LAST_PAGES = 3'd5; // 10 and 11
    // What is done with sources as they are
    localparam [4:0] OWN_STATUS = 5'd1, FRAME_STATUS = 5'd2, CENSUS = 5'd3, CHOOSE = 5'd4;
    localparam [4:0] NEARER = 5'd5, SLIP = 5'd6, REMEMBER = 5'd7;
    // What compares
    localparam [4:0] LESS = 5'd14, RANK = 5'd15;
    // Status bits that a body can have, and some of them
    localparam [15:0] BODY_BITS = 16'h0446;
    localparam integer NO_CONTACT = 0;
    localparam integer SATURATED = 3;
    localparam integer DOUBTFUL = 6;
    localparam integer MORE_BODIES = 7;
    localparam integer SLIPS = 10;
    localparam [7:0] RECORDS = CONTACTS[7:0];

    generate
        if ((CONTACTS < 2) || (CONTACTS > 8) || (OUT_WIDTH != $clog2(16 + 8 * CONTACTS))) begin : gen_check
            sptfra_error_contacts_must_be_2_to_8 invalid ();
        end
    endgenerate

    // ---- The program
    wire [26:0] instruction;
    wire [4:0] what = instruction[26:22];
    wire idle, ending, first, third, finish;
    wire [3:0] i;
    wire [3:0] j;
    wire unit_done;

    sptfra_records_control #(
        .CONTACTS       (CONTACTS),
        .PROGRAM_LENGTH (PROGRAM_LENGTH),
        .ROM_DIR        (ROM_DIR),
        .FILE           (FILE)
    ) control (
        .clock       (clock),
        .reset       (reset),
        .start       (start),
        .kept        (kept),
        .unit_done   (unit_done),
        .idle        (idle),
        .done        (done),
        .ending      (ending),
        .instruction (instruction),
        .i           (i),
        .j           (j),
        .first       (first),
        .third       (third),
        .finish      (finish)
    );

    function [7:0] address(
        input [2:0] place, input [3:0] word, input [3:0] body_i, input [3:0] body_j, input [2:0] last
    );
        case (place)
            OF_I: address = {body_i, word};
            OF_J: address = {body_j, word};
            OF_FRAME: address = {FRAME_PAGE, word};
            LAST: address = {LAST_PAGES, last, word[1:0]};
            default: address = {SCRATCH_PAGE, word};
        endcase
    endfunction

    // ---- Sources: a word of the memory, or a constant, a cycle after its place
    wire [6:0] source = first ? instruction[14:8] : instruction[7:1];
    reg is_constant;
    reg [31:0] constant;
    wire [31:0] memory_word;
    wire [31:0] operand = is_constant ? constant : memory_word;
    reg [31:0] operand_a;

    always @(posedge clock) begin
        is_constant <= (source[6:4] == CONSTANT);
        case (source[3:0])
            4'd1: constant <= 32'h3f800000; // 1
            4'd2: constant <= CHANGE_SQUARED;
            4'd3: constant <= MIDDLE_X;
            4'd4: constant <= MIDDLE_Y;
            4'd5: constant <= NEARNESS;
            4'd6: constant <= LIMIT;
            4'd7: constant <= 32'h7f7fffff; // farther than anything
            4'd8: constant <= SLIPS_FROM;
            4'd9: constant <= SLIPS_STILL;
            default: constant <= 32'd0;
        endcase
        if (!third) begin
            operand_a <= operand;
        end
    end

    // ---- Floats
    wire [31:0] unit_result;
    wire below;

    sptfra_float_unit unit (
        .clock     (clock),
        .reset     (reset),
        .start     (third && what[3]),
        .operation (what[2:0]),
        .a         (operand_a),
        .b         ({operand[31] && !instruction[0], operand[30:0]}),
        .done      (unit_done),
        .result    (unit_result),
        .below     (below)
    );

    // ---- What is known of the frame: held from start on; bodies of each rank; status bits
    reg [7:0] bodies_held;
    reg [16*CONTACTS-1:0] taxels_held;
    reg [3*CONTACTS-1:0] ranks;
    reg less; // the last comparison's first source
    reg slips; // the body
    reg [15:0] any_bits; // of its bodies, and of what is between them
    wire [15:0] own_bits = (operand[15:0] & BODY_BITS) | ({15'd0, less} << DOUBTFUL) | ({15'd0, slips} << SLIPS);
    wire [15:0] more_bits = {15'd0, bodies_held > RECORDS} << MORE_BODIES;
    wire [2:0] rank = ranks[3*i[2:0] +: 3];

    always @(posedge clock) begin
        if (idle && start) begin
            bodies_held <= bodies;
            taxels_held <= taxels;
            ranks <= {(3 * CONTACTS){1'b0}};
            less <= 1'b0;
            slips <= 1'b0;
            any_bits <= {15'd0, saturated} << SATURATED;
        end
        if (finish && (what == LESS)) begin
            less <= below;
        end
        if (finish && (what == SLIP)) begin
            slips <= !less;
            less <= 1'b0;
        end
        if (finish && (what == RANK)) begin
            if (below) begin
                ranks[3*i[2:0] +: 3] <= ranks[3*i[2:0] +: 3] + 3'd1;
            end else begin
                ranks[3*j[2:0] +: 3] <= ranks[3*j[2:0] +: 3] + 3'd1;
            end
        end
        if (finish && (what == OWN_STATUS)) begin
            any_bits <= any_bits | own_bits | ({15'd0, operand[SATURATED]} << SATURATED);
        end
    end

    // ---- Bodies of the last frame, which one that tells nothing is not
    reg [3:0] last_bodies;
    reg [3:0] kept_held;

    always @(posedge clock) begin
        if (idle && start) begin
            kept_held <= kept;
        end
        if (finish && (what == REMEMBER) && ((kept_held != 4'd0) || operand[NO_CONTACT])) begin
            last_bodies <= kept_held;
        end
        if (reset) begin
            last_bodies <= 4'd0;
        end
    end

    // ---- Results: the unit's in the cycle in which it is done, others a cycle later, in the next instruction's first
    reg moving;
    wire written = (what == NEARER) ? less && (j < last_bodies) : (what == SLIP) ? less : (what != REMEMBER);
    reg [31:0] moved;
    reg [6:0] moved_to;

    always @(posedge clock) begin
        moving <= finish && !what[3] && written && !reset;
        moved_to <= instruction[21:15];
        case (what)
            OWN_STATUS: moved <= {own_bits, taxels_held[16*i[2:0] +: 16]};
            FRAME_STATUS: moved <= {operand[31:16], (operand[15:0] & ~BODY_BITS) | any_bits | more_bits};
            CENSUS: moved <= {operand[31:8], bodies_held};
            // The second one where the first is more than zero
            CHOOSE: moved <= (!operand_a[31] && (operand_a[30:23] != 8'd0)) ? operand : 32'd0;
            default: moved <= operand;
        endcase
    end

    wire has_result = moving || (finish && what[3] && (what != LESS) && (what != RANK));
    wire [31:0] result = moving ? moved : unit_result;
    wire [2:0] to_place = moving ? moved_to[6:4] : instruction[21:19];
    wire [3:0] to_word = moving ? moved_to[3:0] : instruction[18:15];
    wire out = (to_place == OUT_FRAME) || (to_place == OUT_RECORD);
    // Of a body's words the last two are for the round before, of that only F_x and F_y are known
    wire in_kept = in_before ? (!in_body[3] && (in_word[3:1] == 3'd1)) : (in_body[3] || (in_word < 4'd14));
    wire [7:0] in_address = {in_body, in_before ? {3'b111, in_word[0]} : in_word};

    sptfra_ram #(
        .WIDTH         (32),
        .DEPTH         (256),
        .ADDRESS_WIDTH (8)
    ) words (
        .clock         (clock),
        .write_enable  (idle ? (in_write && in_kept) : (has_result && !out)),
        .write_address (idle ? in_address : address(to_place, to_word, i, j, i[2:0])),
        .write_data    (idle ? in_data : result),
        .read_enable   (1'b1),
        .read_address  (address(source[6:4], source[3:0], i, j, j[2:0])),
        .read_data     (memory_word)
    );

    // ---- Words before the field, and which of them there are; eight words are a row
    localparam integer ROW_WIDTH = OUT_WIDTH - 3;
    reg [3:0] kept_0; // in the first bank
    reg [3:0] kept_1;
    reg absent;
    wire [3:0] write_row = (to_place == OUT_FRAME) ? {3'd0, to_word[3]} : {1'b0, rank} + 4'd2;
    wire [3:0] read_row = { {(4-ROW_WIDTH){1'b0}}, out_address[OUT_WIDTH-1:3]};
    wire [31:0] out_data;

    sptfra_ram #(
        .WIDTH         (32),
        .DEPTH         (2 << OUT_WIDTH),
        .ADDRESS_WIDTH (OUT_WIDTH + 1)
    ) banks (
        .clock         (clock),
        .write_enable  (has_result && out),
        .write_address ({!out_bank, write_row[ROW_WIDTH-1:0], to_word[2:0]}),
        .write_data    (result),
        .read_enable   (1'b1),
        .read_address  (out_address),
        .read_data     (out_data)
    );

    assign out_word = absent ? 32'd0 : out_data;

    always @(posedge clock) begin
        absent <= (read_row >= (out_address[OUT_WIDTH] ? kept_1 : kept_0) + 4'd2);
        if (idle && start && out_bank) begin
            kept_0 <= kept;
        end
        if (idle && start && !out_bank) begin
            kept_1 <= kept;
        end
        if (ending) begin
            out_bank <= !out_bank;
        end
        if (reset) begin
            out_bank <= 1'b0;
            kept_0 <= 4'd0;
            kept_1 <= 4'd0;
        end
    end

`ifdef SIMULATION
    integer count;
    reg [15:0] expected;

    always @(posedge clock) begin
        count <= (idle && start) ? 1 : count + 1;
        if (idle && start) begin
            expected <= LATENCIES[16*kept +: 16];
        end
        if (done && !reset && (expected != 16'd0) && (count != {16'd0, expected})) begin
            $fdisplay(32'h80000002, "%m: %0d cycles from start to done, expected %0d", count, expected);
            $finish;
        end
        if ((start || in_write) && !idle && !reset) begin
            $fdisplay(32'h80000002, "%m: a header or a start while the records of a frame are made");
            $finish;
        end
        if (start && !reset && (kept > RECORDS[3:0])) begin
            $fdisplay(32'h80000002, "%m: %0d bodies kept, of %0d", kept, CONTACTS);
            $finish;
        end
    end
`else
    wire _unused_check = (LATENCIES != {(16 * (CONTACTS + 1)){1'b0}});
`endif

    wire _unused = &{1'b0, write_row};

endmodule

`default_nettype wire
