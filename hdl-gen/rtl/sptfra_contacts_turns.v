// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// What is done with the oldest frame that the core has answered, step by step.

`default_nettype none

module sptfra_contacts_turns #(
    // Words of a field
    parameter WORDS = 300,
    // Derived
    parameter PLACE_WIDTH = $clog2(WORDS)
) (
    input  wire clock,
    input  wire reset,
    // The oldest answer
    input  wire there,
    input  wire [7:0] exponent, // the largest of its forces
    output reg  signed [9:0] unit, // power of two of a step of its forces
    output wire next, // it leaves
    // What presses most, as a weight
    output wire weighs_largest,
    // Its words before the field
    output reg  [3:0] header_address,
    output reg  header_there,
    output reg  [3:0] header_index,
    input  wire [7:0] header_bodies, // of the word of that index
    output reg  is_contact,
    // Its bodies
    output wire count_start,
    input  wire counted,
    input  wire parted,
    input  wire [3:0] kept,
    output reg  several,
    // The forces found as if there were one
    output wire load_start,
    output reg  [PLACE_WIDTH-1:0] place,
    output reg  load_valid, // a word has been read
    output wire loads,
    input  wire settled,
    // No frame begins, and none is inside the core
    output reg  hold,
    input  wire core_is_empty,
    output reg  with_bodies, // what goes through the core is of bodies
    output reg  is_second, // round
    output wire part_start,
    input  wire part_done,
    output wire send_start,
    output reg  [3:0] body, // that is sent
    input  wire sent,
    output reg  [3:0] answering, // whose answer comes
    input  wire answer_last,
    output wire adds, // to the forces of another
    // The words before the field, and out
    output wire record_start,
    input  wire record_done,
    input  wire output_idle
);

    localparam [3:0]
        IDLE    = 4'd0,
        LARGEST = 4'd1,
        COUNTS  = 4'd2, // bodies are counted, the words before the field copied
        WAITS   = 4'd3, // for the regions, and for the frame before to leave
        LOADS   = 4'd4,
        DRAINS  = 4'd5, // the core answers the frames that it has
        PARTS   = 4'd6, // what each body causes
        SENDS   = 4'd7, // the bodies' frames, while answers come
        ADDS    = 4'd8, // the last answers
        RECORDS = 4'd9,
        LEAVES  = 4'd10;

    localparam ONE = 1;
    localparam [31:0] LAST_PLACE = WORDS - 1;
    // From an exponent to a step, of which the largest force has 2^22 at least
    localparam signed [9:0] TO_UNIT = 10'sd149;
    // Word that has the number of bodies
    localparam [3:0] CENSUS = 4'd13;
    // From a normal force to its weight
    localparam [1:0] TO_WEIGHT = 2'd3;

    reg [3:0] state;
    reg begins; // first cycle of a state, or of a body
    reg [1:0] cycle;
    reg copies;
    reg is_counted;
    reg is_parted;
    reg reads;
    reg [3:0] answered; // bodies whose forces are added

    assign weighs_largest = (state == LARGEST);
    assign count_start = (state == COUNTS) && begins;
    assign loads = (state == LOADS);
    assign load_start = loads && begins;
    assign part_start = (state == PARTS) && begins;
    assign send_start = (state == SENDS) && begins;
    assign record_start = (state == RECORDS) && begins;
    assign next = (state == LEAVES) && output_idle;
    assign adds = with_bodies && (answered != 4'd0);

    always @(posedge clock) begin
        begins <= 1'b0;
        case (state)
            IDLE: begin
                unit <= $signed({2'b00, exponent}) - TO_UNIT;
                cycle <= 2'd0;
                if (there) begin
                    state <= LARGEST;
                end
            end
            LARGEST: begin
                cycle <= cycle + 2'd1;
                if (cycle == TO_WEIGHT) begin
                    state <= COUNTS;
                    begins <= 1'b1;
                end
            end
            COUNTS: begin
                if (is_counted && !begins && !copies && !header_there) begin
                    several <= (kept > 4'd1);
                    hold <= (kept > 4'd1);
                    state <= (kept > 4'd1) ? WAITS : RECORDS;
                    begins <= 1'b1;
                end
            end
            WAITS: begin
                if (is_parted && output_idle) begin
                    state <= LOADS;
                    begins <= 1'b1;
                end
            end
            LOADS: begin
                if (settled) begin
                    state <= DRAINS;
                end
            end
            DRAINS: begin
                if (core_is_empty) begin
                    state <= PARTS;
                    begins <= 1'b1;
                    with_bodies <= 1'b1;
                    is_second <= 1'b0;
                end
            end
            PARTS: begin
                body <= 4'd0;
                answering <= 4'd0;
                answered <= 4'd0;
                if (part_done) begin
                    state <= SENDS;
                    begins <= 1'b1;
                end
            end
            SENDS: begin
                if (sent) begin
                    body <= body + 4'd1;
                    begins <= (body + 4'd1 != kept);
                    if (body + 4'd1 == kept) begin
                        state <= ADDS;
                    end
                end
            end
            ADDS: begin
                if (answered == kept) begin
                    begins <= 1'b1;
                    is_second <= !is_second;
                    with_bodies <= !is_second;
                    hold <= !is_second;
                    state <= is_second ? RECORDS : PARTS;
                end
            end
            RECORDS: begin
                if (record_done) begin
                    state <= LEAVES;
                end
            end
            default: begin // LEAVES
                if (output_idle) begin
                    state <= IDLE;
                end
            end
        endcase
        if (with_bodies && answer_last) begin
            answering <= answering + 4'd1;
        end
        if (with_bodies && settled) begin
            answered <= answered + 4'd1;
        end
        if (reset) begin
            state <= IDLE;
            begins <= 1'b0;
            hold <= 1'b0;
            with_bodies <= 1'b0;
            is_second <= 1'b0;
        end
    end

    // ---- Words before the field are copied while bodies are counted
    always @(posedge clock) begin
        header_there <= copies;
        header_index <= header_address;
        if (header_there && (header_index == CENSUS)) begin
            is_contact <= (header_bodies != 8'd0);
        end
        if (copies) begin
            header_address <= header_address + 4'd1;
            copies <= (header_address != 4'd15);
        end
        is_counted <= is_counted || counted;
        is_parted <= is_parted || parted;
        if (count_start) begin
            header_address <= 4'd0;
            copies <= 1'b1;
            is_counted <= 1'b0;
            is_parted <= 1'b0;
        end
        if (reset) begin
            copies <= 1'b0;
            header_there <= 1'b0;
            is_counted <= 1'b0;
            is_parted <= 1'b0;
        end
    end

    // ---- A field is read
    always @(posedge clock) begin
        load_valid <= reads;
        if (reads) begin
            place <= place + ONE[PLACE_WIDTH-1:0];
            reads <= (place != LAST_PLACE[PLACE_WIDTH-1:0]);
        end
        if (load_start) begin
            place <= {PLACE_WIDTH{1'b0}};
            reads <= 1'b1;
        end
        if (reset) begin
            reads <= 1'b0;
            load_valid <= 1'b0;
        end
    end

endmodule

`default_nettype wire
